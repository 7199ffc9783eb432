"""The player's body: MakeHuman's mesh, shapes, clothes, pose, racket."""
