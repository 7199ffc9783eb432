"""The table of simulated players: errors of skeletons, clocks and kinematics, by views and rule."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from courtside.evaluation import joints
from courtside.records.keypoints import skeleton
from courtside.study.errors import StrPath
from courtside.study.methods import STAGE_WORDS, Fusion

TAKE = ["session", "take", "calibration", "model"]
KEY = [*TAKE, "fusion"]
TEXT = (*KEY, "stage", "person", "joint", "point", "camera", "status")
STAGES = STAGE_WORDS | {"pose3d_ik": "model"}
LEVELS = (50, 90, 95)
POINTS = ("neck", "centre", "mass")
OTHERS = {"two": ("dlt",), "three": ("dlt", "halfbody"), "all": ("dlt",)}  # compared with ours
GAIN = ["median_mm", "p95_mm"]
ENDS = [f"{name}_{end}_mm" for name in ("median", "p95") for end in ("from", "to")]


def read(paths: Sequence[StrPath]) -> pd.DataFrame:
    """Read evaluations of takes, all of one kind, into one table; empty if there are no files."""
    tables = [pd.read_csv(path, dtype=dict.fromkeys(TEXT, str)) for path in paths]
    tables = [table for table in tables if len(table)]
    return pd.concat(tables, ignore_index=True) if tables else pd.DataFrame()


def together(errors: pd.DataFrame) -> pd.DataFrame:
    """Return the rows that pool all persons of a take, or of its only person.

    `errors` is a table of `courtside.evaluation.joints.table` with labels. identity_percent, if it
    is there, is that of the person who is mistaken most often.
    """
    errors = errors.reset_index(drop=True)
    groups = errors.groupby([*KEY, "stage", "joint"], dropna=False)
    rows = errors[(groups["person"].transform("size") == 1) | (errors["person"] == "all")].copy()
    if "identity_percent" in errors:
        least = groups["identity_percent"].transform("min")
        rows["identity_percent"] = least.loc[rows.index]
    return rows.reset_index(drop=True)


def table(
    errors: pd.DataFrame, kinematics: pd.DataFrame, clocks: pd.DataFrame, gains: pd.DataFrame
) -> pd.DataFrame:
    """Summarise the evaluations of takes, one row per take, calibration, network, fusion and stage.

    Over the 12 limb joints. On rows of the robust rule its gain over others: ours minus the other.
    `beats_others` is by the paired comparison, or by the plain one if there is no paired one. On
    rows of the stage that is measured, the kinematics of the person with the largest errors; on raw
    rows, the clocks of the take.

    The arguments are of `read`: tables of `evaluate_take`, `evaluate_kinematics`, `evaluate_clocks`
    and `evaluate_fusions`; all but the first may be empty.
    """
    rows = together(errors)
    in_one = rows[rows["joint"] == "limbs"].set_index([*KEY, "stage"])
    names = ["n", "missing_percent", "median_mm", "p95_mm", "sigma_mm"]
    names += ["bias_mm", "unbiased_median_mm", "unbiased_p95_mm"]
    covered = [f"coverage_{level}_percent" for level in LEVELS]
    covered += ["n_large", "coverage_90_large_percent"]
    found = in_one.reindex(columns=[*names, *covered, "identity_percent"])
    found = found.join(_over_joints(rows[rows["joint"].isin(skeleton.JOINTS)])).reset_index()
    found = _gains(found, gains)
    clocked = _clocks(clocks).assign(stage="pose3d")
    for part, on in ((_kinematics(kinematics), KEY), (clocked, TAKE)):
        if len(part):
            found = found.merge(part, on=[*on, "stage"], how="left", validate="many_to_one")
    counts = [name for name in found if name.startswith("n_clocks")]
    found = found.astype(dict.fromkeys(counts, "Int64"))
    order = found["stage"].map({stage: at for at, stage in enumerate(STAGES)})
    found = found.assign(order=order).sort_values([*KEY, "order"], kind="stable")
    found["stage"] = found["stage"].map(STAGES)
    return found.drop(columns="order").reset_index(drop=True)


def _over_joints(rows: pd.DataFrame) -> pd.DataFrame:
    groups = rows.groupby([*KEY, "stage"])
    found = {"worst_joint_median_mm": groups["median_mm"].max()}
    for level in LEVELS:
        column = f"coverage_{level}_percent"
        found[f"coverage_{level}_least_percent"] = groups[column].min()
        found[f"coverage_{level}_most_percent"] = groups[column].max()
    within = rows.assign(within=rows["coverage_90_percent"].between(*joints.WANTED_90))
    found["joints_within"] = within.groupby([*KEY, "stage"])["within"].sum()
    found["joints_stated"] = groups["coverage_90_percent"].count()
    return pd.DataFrame(found)


def _gains(rows: pd.DataFrame, gains: pd.DataFrame) -> pd.DataFrame:
    values = rows.set_index([*KEY, "stage"])
    paired = {} if gains.empty else gains.set_index([*KEY, "stage", "than"]).to_dict("index")
    found = []
    for key, row in values.iterrows():
        fusion = Fusion.parse(key[-2])
        ours = fusion.rule == "robust" and fusion.steadied
        others = OTHERS.get(fusion.cameras, ()) if ours else ()
        gained: dict = {}
        nearer: list[bool] = []
        for other in others:
            than = other if other == "halfbody" else f"{fusion.cameras}-{other}"
            against = (*key[:-2], than, key[-1])
            if against not in values.index:
                continue
            plain = {name: row[name] - values.loc[against, name] for name in GAIN}
            best = paired.get((*key, than), {})
            gained |= {f"vs_{other}_{name}": value for name, value in plain.items()}
            gained |= {f"vs_{other}_paired_{name}": best.get(name) for name in [*GAIN, *ENDS]}
            nearer += [best.get(name, plain[name]) < 0 for name in GAIN]
        gained["beats_others"] = ("yes" if all(nearer) else "no") if nearer else ""
        found.append(gained)
    kinds = [*GAIN, *(f"paired_{name}" for name in [*GAIN, *ENDS])]
    columns = [f"vs_{other}_{kind}" for other in ("dlt", "halfbody") for kind in kinds]
    whole = pd.DataFrame(found, index=rows.index).reindex(columns=[*columns, "beats_others"])
    return rows.join(whole.astype(dict.fromkeys(columns, float)))


def _kinematics(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the worst of each number over the persons of a take, points side by side.

    NaN where it is unknown of one of them, who may be the worst.
    """
    if rows.empty:
        return rows
    key = [*KEY, "stage"]
    found = {"kinematics_seconds": rows.groupby(key)["seconds"].min()}
    for point in POINTS:
        groups = rows[rows["point"] == point].groupby(key)
        found[f"{point}_distance_error_percent"] = groups["distance_error_percent"].agg(furthest)
        found[f"{point}_speed_rmse_m_s"] = groups["speed_rmse_m_s"].agg(furthest)
    return pd.DataFrame(found).reset_index()


def _clocks(rows: pd.DataFrame) -> pd.DataFrame:
    if rows.empty:
        return rows
    used = rows[rows["status"] == "found"]
    within = used["within_90_percent"].astype(str) == "True"
    groups = used.assign(within=within).groupby(TAKE)
    found = {
        "n_clocks": rows.groupby(TAKE).size(),
        "n_clocks_found": groups.size(),
        "n_clocks_within": groups["within"].sum(),
        "clock_error_ms": groups["worst_error_ms"].agg(furthest),
    }
    whole = pd.DataFrame(found).reset_index()
    return whole.fillna({"n_clocks_found": 0, "n_clocks_within": 0})


def furthest(values: pd.Series) -> float:
    """Return the value that is furthest from zero, with its sign; NaN if one is unknown."""
    every = values.to_numpy(dtype=float)
    return every[np.abs(every).argmax()] if len(every) and np.isfinite(every).all() else np.nan
