"""Numbers of the correction of joints: real footage beside virtual, each against its reference."""

from courtside.evaluation.numbers import players, stated
from courtside.evaluation.numbers.register import Builder, Cut, Number, Settings, Source

TABLE = "footage"
# Takes shown beside real footage: the longest of those reported, and one of another layout.
VIRTUAL = (("players-b", "footwork"), ("players-a", "shot"))
CONVENTION = "true joint centres of the rig"


def corrections(source: Source, documents: Source) -> list[Number]:
    """Return the distances to each reference, raw, filtered and corrected: virtual, then real."""
    build, table = Builder(TABLE), source.table(players.TABLE)
    table = table[(table["fusion"] == players.OURS) & (table["model"] == "blazepose-full")]
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
