"""What movement is made of, against virtual truth.

contacts: `table`, `errors`, `true_contact`: which foot stands, onsets and ends of stances
reactions: `table`, `answers`, `summary`: split steps and reactions against the true ones
strokes: `table`, `hits`, `summary`: strokes and each hypothesis against the true hits
"""
