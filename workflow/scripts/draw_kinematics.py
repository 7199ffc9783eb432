"""Draw the kinematics of one take: tables of frames and measures, court -> figure, CSV."""

from courtside.calibration.court import court as court_files
from courtside.figures.style import style
from courtside.figures.take import kinematics
from courtside.records import tables
from courtside.study.execution.script import run


def main(frames_csv, summary_csv, court_yaml, pdf, png, csv):
    frames = tables.read(frames_csv, "a table of frames")
    summary = tables.read(summary_csv, "a table of measures")
    court = court_files.read(court_yaml) if court_yaml else None
    drawing = kinematics.draw(frames, summary, court)
    style.save(drawing, kinematics.table(frames), pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
