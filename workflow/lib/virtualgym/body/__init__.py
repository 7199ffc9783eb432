"""The player's body: MakeHuman's mesh and rig, shapes, clothes, pose, racket.

- athlete: `Athlete` (a body that moves, with or without a racket)
- skinned_body: `Body`, `JOINTS`
- shapes: `Shape`, `BODIES`, `figure`
- stance: `Stance`, `Proportions`, `joints`, `mirrored`, `moved`
- pose_bones: `pose`, `Skeleton`, `bent`, `grip`
- rotations: `swing`, `twist`, `about_axis`, `shares`: of one bone at a time
- joint_centres: `anatomical`: joints by landmarks, not by the rig
- arm_lengths: `lengthened`: women's forearms
- makehuman: `Archive`, `Figure`
- clothing: `dress`
- racket: `build`, `place`
- mesh: `Mesh`, `join`, `normals`, `volume`
"""
