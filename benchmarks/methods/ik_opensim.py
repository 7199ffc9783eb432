"""OpenSim's inverse kinematics of one TRC file, timed; and a motion played on the model.

Arguments: model.osim markers.trc fitted.trc motion.mot folder.

Every marker of the model counts alike; OpenSim solves markers.trc. `markers_mm` is the largest
distance between the markers of fitted.trc and those of the model posed by the motion file, over its
frames. Coordinates and markers that OpenSim finds are in the folder.
"""

import json
import sys
import time

import numpy as np
import opensim

EACH = 10  # frames of the motion that are played


def played_mm(model, markers, motion_mot):
    """Return the largest distance, mm, of the model's markers from those measured."""
    state, motion = model.initSystem(), opensim.TimeSeriesTable(str(motion_mot))
    names, worst = list(motion.getColumnLabels()), 0.0
    seen_s = np.array(markers.getIndependentColumn())
    for row in range(0, motion.getNumRows(), EACH):
        values = motion.getRowAtIndex(row)
        for one in model.getCoordinateSet():
            value = values[names.index(one.getName())]
            turns = one.getMotionType() == opensim.Coordinate.Rotational
            one.setValue(state, np.radians(value) if turns else value, False)
        model.realizePosition(state)
        at = int(np.argmin(np.abs(seen_s - motion.getIndependentColumn()[row])))
        places = markers.getRowAtIndex(at)
        for column, name in enumerate(markers.getColumnLabels()):
            found = model.getMarkerSet().get(name).getLocationInGround(state).to_numpy()
            apart = 1000 * np.linalg.norm(found - places[column].to_numpy())
            worst = max(worst, float(np.nan_to_num(apart)))
    return worst


def solved(model, markers_trc, folder):
    """Run the tool; return seconds of processor time."""
    tool, markers = opensim.InverseKinematicsTool(), opensim.MarkerData(markers_trc)
    tool.setModel(model)
    tool.setMarkerDataFileName(markers_trc)
    tool.setResultsDir(folder)
    tool.setOutputMotionFileName(f"{folder}/ik.mot")
    tool.set_report_marker_locations(True)
    tool.setStartTime(markers.getStartFrameTime())
    tool.setEndTime(markers.getLastFrameTime())
    for one in model.getMarkerSet():
        task = opensim.IKMarkerTask()
        task.setName(one.getName())
        task.setApply(True)
        task.setWeight(1.0)
        tool.get_IKTaskSet().cloneAndAppend(task)
    start = time.process_time()
    if not tool.run():
        raise RuntimeError("OpenSim's inverse kinematics failed")
    return time.process_time() - start


def main(model_osim, markers_trc, fitted_trc, motion_mot, folder):
    opensim.Logger.setLevelString("Off")
    model = opensim.Model(model_osim)
    fitted = opensim.TimeSeriesTableVec3(fitted_trc)
    report = {"markers_mm": played_mm(model, fitted, motion_mot)}
    report["seconds"] = solved(model, markers_trc, folder)
    print(json.dumps(report))


if __name__ == "__main__":
    main(*sys.argv[1:])
