"""Numbers of joints: corrected, real beside virtual; one by one; of fewer cameras."""

from courtside.evaluation.numbers import players
from courtside.evaluation.numbers.register import Builder, Cut, Number, Source
from courtside.evaluation.tables.players import STAGES
from courtside.records.keypoints import skeleton

TABLE = "footage"
# Takes shown beside real footage: the longest of those reported, and one of another layout.
VIRTUAL = (("players-b", "footwork"), ("players-a", "shot"))
CONVENTION = "true joint centres"
PER_JOINT = ("median", "p95", "coverage")  # of `players.PER_STAGE`
PER_VIEWS = {  # part: column, decimals, unit
    "median": ("median_mm", 0, "mm"),
    "p95": ("p95_mm", 0, "mm"),
    "exchanged": ("exchanged_percent", 0, "%"),
}


def corrections(source: Source) -> list[Number]:
    """Return the errors of virtual joints beside real footage: raw, filtered and corrected."""
    build, table = Builder(TABLE), source.table(players.TABLE)
    table = table[(table["fusion"] == players.OURS) & (table["model"] == players.NETWORK)]
    for session, take in VIRTUAL:
        of = table[(table["session"] == session) & (table["take"] == take)]
        for _, row in of.iterrows():
            where = f"{session}/{take}, {players.OURS}, stage {row['stage']}"
            cut = Cut(source, players.TABLE, where, session)
            name = f"virtual, `{session}/{take}`, against {CONVENTION}"
            shown = {
                f"{row['stage']}_{part}": (f"{part}_mm", 1, "mm") for part in ("median", "p95")
            }
            build.add_columns(name, row, shown, cut, n=row["n"])
    return build.numbers


def views(source: Source) -> list[Number]:
    """Return how far skeletons of fewer cameras are from those of all, in real takes: no errors."""
    build = Builder("views")
    for file in source.names("*/takes/*/views/*.csv"):
        table, parts = source.table(file), file.split("/")
        for _, row in table[table["joint"] == "limbs"].iterrows():
            cut = Cut(source, file, f"fusion {row['fusion']}, joint limbs", parts[0])
            name = f"`{parts[0]}/{parts[2]}`: {players.words(row['fusion'])}"
            build.add_columns(name, row, PER_VIEWS, cut, n=row["n"])
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
            shown = {f"{stage}_{part}": players.PER_STAGE[part] for part in PER_JOINT}
            build.add_columns(name, row, shown, cut, n=row["n"])
    return build.numbers
