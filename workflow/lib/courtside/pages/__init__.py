"""HTML pages in one file each: clicking court points, naming persons, viewer, report.

page: `build`, `render`, `macro`, `write`: one page from templates, scripts, data and pictures
pictures: `shrunk`: a PNG as small as a page needs it
quality: `lines`, `thumbnail`, `build`: the page of a session with verdicts and pictures
clicking, people, viewer, report: One room for each; templates, styles and scripts are in `assets`
"""
