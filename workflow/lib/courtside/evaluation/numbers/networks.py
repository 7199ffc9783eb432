"""Networks on the same frames: virtual takes. Recorded ones, and times, are of a benchmark."""

from courtside.evaluation.numbers.register import Builder, Cut, Number, Source

TABLE, FILE = "networks", "figures/networks.table.csv"
DECIMALS = {"px": 1, "%": 1, "mm": 0, "jitter": 2}  # by unit, of one measure by its name
ENDS = {"": "value", "_from": "value_from", "_to": "value_to"}  # of parts: columns


def label(network: str, session: str) -> str:
    """Return the row of a network in a virtual session."""
    return f"`{network}`; virtual, `{session}`"


def virtual(source: Source) -> list[Number]:
    """Return errors, shares and jitter of each network against the truth, with their intervals."""
    build, table = Builder(TABLE), source.table(FILE)
    for _, row in table[table["against"] == "truth"].iterrows():
        cut = Cut(source, FILE, f"{row['network']}, {row['measure']}", row["session"])
        decimals = DECIMALS.get(row["measure"], DECIMALS[row["unit"]])
        shown = {
            f"{row['measure']}{end}": (name, decimals, row["unit"]) for end, name in ENDS.items()
        }
        name = label(row["network"], row["session"])
        build.add_columns(name, row, shown, cut, n=row["n"], n_failed=0)
    return build.numbers
