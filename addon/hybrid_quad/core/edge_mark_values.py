"""Numbers of the marks that an edge can carry; a sum of them says which it does."""

SHARP = 1
SEAM = 2
FEATURE = 4
CREASE = 8
BEVEL = 16
FREESTYLE = 32
MATERIAL = 64
FACE_SET = 128
UV_ISLAND = 256
