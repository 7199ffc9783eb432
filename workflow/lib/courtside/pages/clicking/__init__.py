"""The page on which court points are clicked."""
