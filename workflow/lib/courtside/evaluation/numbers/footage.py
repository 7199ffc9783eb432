"""Numbers of joints: corrected, real beside virtual; one by one; of fewer cameras."""

from courtside.evaluation.numbers import players, stated
from courtside.evaluation.numbers.register import Builder, Cut, Number, Settings, Source
from courtside.evaluation.tables.players import STAGES
from courtside.records.keypoints import skeleton

TABLE = "footage"
# Takes shown beside real footage: the longest of those reported, and one of another layout.
VIRTUAL = (("players-b", "footwork"), ("players-a", "shot"))
CONVENTION = "true joint centres of the rig"


def corrections(source: Source, documents: Source) -> list[Number]:
    """Return the distances to each reference, raw, filtered and corrected: virtual, then real."""
    build, table = Builder(TABLE), source.table(players.TABLE)
    table = table[(table["fusion"] == players.OURS) & (table["model"] == players.NETWORK)]
    for session, take in VIRTUAL:
        of = table[(table["session"] == session) & (table["take"] == take)]
        for _, row in of.iterrows():
            where = f"{session}/{take}, {players.OURS}, stage {row['stage']}"
            cut = Cut(source, players.TABLE, where, session)
            name = f"virtual, `{session}/{take}`, against {CONVENTION}"
            for part in ("median", "p95"):
                column, key = f"{part}_mm", f"{row['stage']}_{part}"
                more: Settings = {"decimals": 1, "unit": "mm", "n": row["n"]}
                build.add(name, key, row[column], cut, column, **more)
    return [*build.numbers, *stated.numbers(documents, TABLE)]


def views(source: Source) -> list[Number]:
    """Return how far skeletons of fewer cameras are from those of all, in real takes: no errors."""
    build = Builder("views")
    for file in source.names("*/takes/*/views/*.csv"):
        table, parts = source.table(file), file.split("/")
        for _, row in table[table["joint"] == "limbs"].iterrows():
            cut = Cut(source, file, f"fusion {row['fusion']}, joint limbs", parts[0])
            name = f"`{parts[0]}/{parts[2]}`: {players.words(row['fusion'])}"
            more: Settings = {"decimals": 0, "unit": "mm", "n": row["n"]}
            build.add(name, "median", row["median_mm"], cut, "median_mm", **more)
            build.add(name, "p95", row["p95_mm"], cut, "p95_mm", **more)
            more |= {"unit": "%"}
            swapped = row["exchanged_percent"]
            build.add(name, "exchanged", swapped, cut, "exchanged_percent", **more)
    return build.numbers


def joints(source: Source) -> list[Number]:
    """Return the errors of single joints of the virtual takes shown beside real footage."""
    build = Builder("joints")
    for session, take in VIRTUAL:
        (file,) = source.names(f"{session}/evaluation/takes/{take}/errors/*.{players.NETWORK}.csv")
        table = source.table(file)
        table = table[(table["fusion"] == players.OURS) & table["joint"].isin(skeleton.JOINTS)]
        for _, row in table[table["person"] != "all"].iterrows():
            stage = STAGES[row["stage"]]
            cut = Cut(source, file, f"{players.OURS}, {stage}, {row['joint']}", session)
            name = f"{row['joint'].replace('_', ' ')}, `{session}/{take}`"
            more: Settings = {"decimals": 0, "n": row["n"]}
            for part in ("median", "p95"):
                column = f"{part}_mm"
                build.add(name, f"{stage}_{part}", row[column], cut, column, unit="mm", **more)
            held = "coverage_90_percent"
            build.add(name, f"{stage}_coverage", row[held], cut, held, unit="%", **more)
    return build.numbers
