"""What error to expect of a planned session.

cameras: camera, walked_cameras, places_on_path: planned cameras; path_order, path_angles_deg:
    angles between their views
tie_points: network: a simulated network of tie points; TEXTURES: how much there is to see in a hall
prediction: predict, needed: the error to expect, and the number of bridging images that is enough
"""
