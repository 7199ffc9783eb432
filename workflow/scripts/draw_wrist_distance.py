"""Draw the wrists' distance with T-poses and claps: tables of wrists and events -> figure, CSV."""

from courtside.figures.devices import wrist_distance
from courtside.figures.style import style
from courtside.study.execution.script import run


def main(wrists_csv, events_csv, pdf, png, csv, *, aligned, kinds):
    wrists, events = wrist_distance.read(wrists_csv, events_csv)
    events = wrist_distance.table(wrists, events, aligned=aligned)
    drawing = wrist_distance.draw(wrists, events, kinds=kinds, aligned=aligned)
    style.save(drawing, events, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
