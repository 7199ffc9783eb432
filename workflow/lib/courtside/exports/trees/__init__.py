"""Joints as trees of bones in motion, for animation programs.

posing: `of_joints`, `rested`, `turned`, `even`: what BVH and GLB need of joints and motions
gltf: `write`: GLB (glTF 2.0)
"""
