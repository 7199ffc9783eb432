"""Cameras in the forms of other programs, each turned into this study's convention.

forms: `FORMS`, `refused`: what is read, and the line for what is not
xml_fields: `parse`, `attributes`: of Qualisys, Vicon and OptiTrack
inverse_lens: `coefficients`: a lens stated as its inverse
qualisys, vicon, optitrack, opencv, easymocap, opencap, colmap: `read`
"""
