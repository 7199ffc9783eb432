"""Find contacts of the feet with the floor: skeletons -> contacts, steps, events, measures."""

from courtside.calibration.court import court
from courtside.footwork import feet, measures
from courtside.kinematics import cutoffs
from courtside.records import footwork, tables
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution.script import run


def main(paths, contacts_npz, steps_csv, events_csv, summary_csv):
    points, (chosen, _) = keypoints.read_3d(paths.skeletons), cutoffs.read(paths.cutoffs)
    per_joint = skeleton.read(paths.skeleton).by_group(chosen)
    contacts, steps, events = feet.find(points, per_joint)
    footwork.write_contacts(contacts_npz, contacts)
    footwork.write_steps(steps_csv, steps)
    footwork.write_events(events_csv, events)
    lines = court.read(paths.court) if paths.court else None
    tables.write(summary_csv, measures.summary(steps, events, lines))


if __name__ == "__main__":
    run(main, snakemake)
