"""Numbers of one camera and devices: errors of inertial suits and depth, as they are, corrected."""

from courtside.evaluation.numbers.register import Builder, Cut, Number, Source, listed

ALIGNMENTS = {"body_frame": "body", "root_relative": "root"}  # of the evaluation: part


def sources(source: Source) -> list[Number]:
    """Return the errors of every source of a take, limb joints together.

    In the body frame of its own T-pose, and with the hips laid on top of one another.
    """
    build = Builder("devices")
    for file in source.names("*/evaluation/takes/*/sources/*.errors.csv"):
        table, parts = source.table(file), file.split("/")
        whole = table[(table["joint"] == "all") & table["alignment"].isin(ALIGNMENTS)]
        for _, row in whole.iterrows():
            where = f"source {row['source']}, alignment {row['alignment']}, joint all"
            cut = Cut(source, file, where, parts[0])
            name = f"`{parts[0]}/{parts[3]}`: `{row['source']}`"
            aligned = ALIGNMENTS[row["alignment"]]
            shown = {f"{aligned}_{part}": (f"{part}_mm", 0, "mm") for part in ("median", "p95")}
            build.add_columns(name, row, shown, cut, n=row["n"])
    return build.numbers


def body_frames(source: Source) -> list[Number]:
    """Return how far the body frame of each source's T-pose is from the true one."""
    found, shown = [], {"angle": ("angle_deg", 1, "degrees"), "unit": ("unit_percent", 1, "%")}
    for file in source.names("*/evaluation/takes/*/body_frames/*.csv"):
        parts, table = file.split("/"), source.table(file)
        rows = {f"`{parts[0]}/{parts[3]}`: `{row['source']}`": row for _, row in table.iterrows()}
        found += listed(Cut(source, file, "by source", parts[0]), "body-frames", rows, shown)
    return found
