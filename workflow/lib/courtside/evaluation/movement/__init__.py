"""What movement is made of, against virtual truth.

contacts: `table`, `paired`, `true_contact`: which foot stands, onsets and ends of stances
reactions: `table`, `answers`: split steps and reactions against the true ones
strokes: `table`, `hits`: strokes and each hypothesis against the true hits
"""
