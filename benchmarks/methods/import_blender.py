"""Import BVH and GLB files into Blender, and say where it has each bone, frame by frame.

Arguments: result.npz file ... The options are those of the file dialogue, except for BVH the scale
of centimetres, the frame rate and the duration. Of the n-th file `<n>_xyz` (T, B, 3) are the heads
of the bones in Blender's world, z up, in the frames with keys, at `<n>_time_s`; `<n>_bones` are
their names, the root first. `loose` is the number of objects that no armature moves.
"""

import contextlib
import io
import json
import sys

import bpy
import numpy as np

OF_BVH = {"global_scale": 0.01, "update_scene_fps": True, "update_scene_duration": True}


def keys(action):
    """Return the frames with keys."""
    bags = [bag for layer in action.layers for strip in layer.strips for bag in strip.channelbags]
    curves = [curve for bag in bags for curve in bag.fcurves]
    return sorted({round(key.co[0], 4) for curve in curves for key in curve.keyframe_points})


def imported(path):
    """Return the arrays of one file, and the number of loose objects."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with contextlib.redirect_stdout(io.StringIO()):
        if path.endswith(".bvh"):
            bpy.ops.import_anim.bvh(filepath=path, **OF_BVH)
        else:
            bpy.ops.import_scene.gltf(filepath=path)
    scene, (figure,) = (
        bpy.context.scene,
        [one for one in bpy.data.objects if one.type == "ARMATURE"],
    )
    known = {figure, *(bone.custom_shape for bone in figure.pose.bones)}
    known |= {one for one in scene.objects if any(m.type == "ARMATURE" for m in one.modifiers)}
    frames = keys(figure.animation_data.action)
    xyz = []
    for frame in frames:
        scene.frame_set(int(frame // 1), subframe=frame % 1)
        xyz.append([figure.matrix_world @ bone.head for bone in figure.pose.bones])
    begin = 1 if path.endswith(".bvh") else 0  # BVH starts at frame 1, glTF's second 0 is frame 0
    per_s = scene.render.fps / scene.render.fps_base
    found = {
        "xyz": np.array(xyz),
        "time_s": (np.array(frames) - begin) / per_s,
        "bones": [bone.name for bone in figure.pose.bones],
    }
    return found, len(set(scene.objects) - known)


def main(result_npz, *files):
    made, loose = {}, 0
    for at, path in enumerate(files):
        found, more = imported(path)
        made |= {f"{at}_{name}": values for name, values in found.items()}
        loose += more
    np.savez(result_npz, **made)
    print(json.dumps({"blender": bpy.app.version_string, "loose": loose}))


if __name__ == "__main__":
    main(*sys.argv[1:])
