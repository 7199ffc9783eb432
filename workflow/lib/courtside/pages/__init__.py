"""Pages in one HTML file each: clicking, viewer, report.

page: `build`, `render`, `macro`, `write`: one page from templates, scripts, data and pictures
pictures: `shrunk`: a PNG as small as a page needs it
clicking, viewer, report: One room for each page; templates, styles and scripts are in `assets`
"""
