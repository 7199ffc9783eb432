"""The page on which the persons found in a take are named.

strips: `times`, `pictures`: when each person is shown, and the pictures of one camera
page: `build`: the page
"""
