"""Renders a scene with PyBullet's software renderer and prints the processor seconds that a picture took.

    python3 tinyrenderer.py SCENE.json PICTURES [--out PICTURE.ppm]

SCENE.json, written by tinyrenderer.cpp: a list of {"position", "rotation" (x, y, z, w), "colour" (0 to 1), "vertices",
"triangles"}; lengths in metres. Needs NumPy (Debian: python3-numpy) and PyBullet:

    python3 -m pip install --no-deps --target DIRECTORY pybullet==3.2.7    # then with PYTHONPATH=DIRECTORY

Exit 77 where they cannot be imported, 1 where the picture does not show every object.
"""
import argparse
import json
import sys
import time

COLUMNS, ROWS = 256, 128


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("scene")
    arguments.add_argument("pictures", type=int)
    arguments.add_argument("--out", help="write the picture there")
    arguments = arguments.parse_args()
    try:
        import numpy  # without it, PyBullet makes a tuple of a picture, which takes longer than drawing it
        import pybullet
    except ImportError:
        return 77
    with open(arguments.scene) as file:
        scene = json.load(file)
    pybullet.connect(pybullet.DIRECT)

    def add(shape, position, rotation):
        return pybullet.createMultiBody(baseVisualShapeIndex=shape, basePosition=position, baseOrientation=rotation)

    table = pybullet.createVisualShape(pybullet.GEOM_BOX, halfExtents=[.4, .7, .01], rgbaColor=[.77, .76, .75, 1])
    add(table, [.5, 0, -.01], [0, 0, 0, 1])
    bodies = []
    for thing in scene:
        shape = pybullet.createVisualShape(pybullet.GEOM_MESH, vertices=thing["vertices"],
                                           indices=sum(thing["triangles"], []), rgbaColor=[*thing["colour"], 1])
        bodies.append(add(shape, thing["position"], thing["rotation"]))

    # From 4 m above, the table's half metre by one metre fills the picture.
    view = pybullet.computeViewMatrix([.5, 0, 4], [.5, 0, 0], [-1, 0, 0])
    projection = pybullet.computeProjectionMatrix(-.25, .25, -.125, .125, 2, 5)

    def render():  # without shadows: those of things so small do not show in it, and would cost it half as much again
        return pybullet.getCameraImage(COLUMNS, ROWS, view, projection, shadow=0, lightDirection=[-.36, -.48, .8],
                                       renderer=pybullet.ER_TINY_RENDERER)

    _, _, rgba, _, ids = render()
    if not set(bodies) <= set(numpy.unique(ids)):
        print("tinyrenderer.py: the picture does not show every object", file=sys.stderr)
        return 1
    if arguments.out:
        with open(arguments.out, "wb") as file:
            file.write(b"P6 %d %d 255\n" % (COLUMNS, ROWS))
            file.write(numpy.asarray(rgba, numpy.uint8).reshape(ROWS, COLUMNS, 4)[:, :, :3].tobytes())
    start = time.process_time()
    for _ in range(arguments.pictures):
        render()
    print((time.process_time() - start) / arguments.pictures)
    return 0


sys.exit(main())
