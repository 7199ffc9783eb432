"""What is wrong with the recordings of a session, found before any job starts.

check: `check`: all sessions of a study; every fault in one `InputError`
calibrated: `faults`: cameras and sizes against the calibration file, sizes of a camera's recordings
views: `faults`: one view given for two cameras, exchanged cameras
lengths: `faults`, `remarks`: numbers of frames and rates of the cameras of a take
remembered: `Remembered`: looks at files, kept from run to run
"""
