"""The page on which court points are clicked.

page: `build`, `frame`, `by_point`: the page, its pictures, earlier clicks
"""
