"""What movement is made of, against virtual truth.

contacts: `table`, `errors`, `true_contact`: which foot stands, onsets and ends of stances
strokes: `table`, `hits`, `summary`: strokes and each hypothesis against the true hits
"""
