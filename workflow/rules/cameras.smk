"""Where the fixed cameras are.

Inputs: a calibration made elsewhere. Outputs: results/{session}/calibration/{calibration}/.
Steps: import_cameras.
"""


rule import_cameras:
    input:
        calibration=lambda w: session_of(w).calibration_file,
    output:
        cameras="results/{session}/calibration/file/cameras.toml",
        quality="results/{session}/calibration/file/quality.json",
    log:
        "results/{session}/logs/import_cameras/file.log",
    params:
        code=code("import_cameras.py"),
        names=lambda w: session_of(w).calibration_camera_names(),
        crops_px=lambda w: {
            name: camera.crop_px
            for name, camera in session_of(w).cameras.items()
            if camera.crop_px
        },
    script:
        "../scripts/import_cameras.py"
