"""The report: what was measured, warnings, figures with captions, quality, methods.

report: `build`: the whole report as one page
coach: `take`, `with_error`: one take in words, a number with its error bar
quality: `session`, `limits`: the quality page of a session, the limits of the marks
methods: `paragraphs`: the methods section
figures: `figure`, `table`, `groups`, `title`: figures and CSV files as HTML
columns: `words`: a column of a table in words
captions: `render`: a figure's caption as HTML
facts: `of_take`, `of_session`, `of_skeleton`: numbers read from the files of the study
warnings: `of_take`, `of_session`: what needs attention, with its level
"""
