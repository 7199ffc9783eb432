"""Files and settings of each job: the input functions of the rules, without Snakemake.

job: the study and the wildcards of a job, used by all others
recordings: videos, folders of pictures, networks, virtual bodies
calibration: structure from motion, cameras, clicking
takes: keypoints, skeletons, measures, exports
devices: devices of their own, their sources, clocks and figures
evaluation: truth, and the results compared with it
figures: figures of the calibration study and of the badminton paper
pages: layers and settings of viewers and videos
report_page: the inputs of the report
"""
