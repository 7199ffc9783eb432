"""Draw the footwork of one take: contacts, steps, events, court -> figure, CSV."""

from courtside.calibration.court import court as court_files
from courtside.figures.style import style
from courtside.figures.take import footwork as drawing
from courtside.records import footwork
from courtside.study.execution.script import run


def main(contacts_npz, steps_csv, events_csv, court_yaml, pdf, png, csv):
    contacts, steps = footwork.read_contacts(contacts_npz), footwork.read_steps(steps_csv)
    court = court_files.read(court_yaml) if court_yaml else None
    drawn = drawing.draw(contacts, steps, footwork.read_events(events_csv), court)
    style.save(drawn, drawing.table(steps), pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
