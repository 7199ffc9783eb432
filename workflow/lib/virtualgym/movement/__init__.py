"""Motions of virtual players: footwork, strokes, walking, T-pose and clap.

- catalogue: `MOTIONS` (name -> function that makes a motion)
- player: `Player`, `hop_rise`, `Motion` (route, feet and poses; gives a stance at any time)
- badminton: `rounds`, `visits`, `Drill`
- exchange: `script`, `perform`, `Shot`
- walking: `large_round`, `small_round`, `up_and_down`, `along`
- single_view: `perform`
- tpose_clap: `perform`, `Arms`, `events`
- footwork: `plan`, `walk`, `Station`, `Route`, `Lap`, `Foot`
- upper_body: `course`, `Pose`, and the poses themselves
- easing: `ease`, `step`, `bump`, `arc`, `Glide`
- two_bone_ik: `bend`, `facing`, `turn`
"""
