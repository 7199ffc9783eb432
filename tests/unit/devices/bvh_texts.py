"""Small BVH texts for tests: one with everything that the format has, and faults made in it."""

ARM = """HIERARCHY
ROOT hips
{
  OFFSET 0 95.5 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT chest
  {
    OFFSET 0 30.25 -1.5
    CHANNELS 4 Yposition Yrotation Xrotation Zrotation
    JOINT arm
    {
      OFFSET 18 12 0
      CHANNELS 3 Xrotation Yrotation Zrotation
      End Site
      {
        OFFSET 25.5 0 0
      }
    }
    JOINT prop
    {
      OFFSET 0 3 12
      CHANNELS 0
    }
  }
  JOINT leg
  {
    OFFSET 9 -4 2
    CHANNELS 1 Xrotation
    End Site
    {
      OFFSET 0 -80 0
    }
  }
}
MOTION
Frames: 3
Frame Time: 0.0166667
0 95.5 0 0 0 0 30.25 0 0 0 0 0 0 0
1.5 94 -2.25 10 -20 30 31 5 -15 25 90 -45 60 -30
1.75 93.5e0 -2 -170 88 170 -29.5 .5 -1.5E1 +25 9.0e+1 -45. 60 1e-3
"""
