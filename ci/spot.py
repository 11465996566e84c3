#!/usr/bin/env python3
"""Makes the data of the benchmark's workloads W9 and W10: Spot the cow, a model by Keenan Crane in the public domain.

    ci/spot.py spot_triangulated.obj spot_texture.png examples/workloads/spot.bin

All numbers are little-endian and of 16 bits:

    2,930 positions        x, y, z, in 1 / 32,768 of a cube's half side of 1.125
    2,930 smooth normals   x, y, z, 2.14: sums of the cross products of all faces at a position, of length 1
    3,225 vertices         number of the position; u, v in 16.16 from the texture's top left corner, low halves first
    5,856 faces            numbers of three vertices, in the model's order
    5,856 face normals     x, y, z, 2.14
    256 x 256 texels       RGB565; means of squares of the picture's pixels, rounded, then cut
"""
import math
import struct
import sys
import zlib

HALF, TEXELS = 1.125, 256


def png(name):
    """Returns the width and the rows of a picture of 8 bits per channel."""
    data, at, packed = open(name, "rb").read(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color, *_ = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    step = {2: 3, 6: 4}[color]
    assert depth == 8
    raw, rows, before = zlib.decompress(packed), [], bytes(step * width)
    for y in range(height):
        at = y * (step * width + 1)
        how, row = raw[at], bytearray(raw[at + 1 : at + 1 + step * width])
        for k in range(len(row)):
            a = row[k - step] if k >= step else 0
            b, c = before[k], before[k - step] if k >= step else 0
            p = a + b - c
            near = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            row[k] = (row[k] + (0, a, b, (a + b) // 2, near)[how]) & 255
        before = row
        rows.append(row)
    return width, step, rows


def texture(name):
    width, step, rows = png(name)
    n, texels = width // TEXELS, []
    for y in range(TEXELS):
        for x in range(TEXELS):
            total = [0, 0, 0]
            for row in rows[y * n : (y + 1) * n]:
                for pixel in range(x * n, (x + 1) * n):
                    for c in range(3):
                        total[c] += row[step * pixel + c]
            r, g, b = ((2 * t + n * n) // (2 * n * n) for t in total)
            texels.append((r >> 3) << 11 | (g >> 2) << 5 | b >> 3)
    return texels


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return [round(16384 * x / length) for x in v]


def main(obj, picture, out):
    positions, uvs, faces = [], [], []
    for line in open(obj):
        word = line.split()
        if not word:
            continue
        if word[0] == "v":
            positions.append([float(x) for x in word[1:4]])
        elif word[0] == "vt":
            uvs.append([float(word[1]), 1 - float(word[2])])
        elif word[0] == "f":
            faces.append([tuple(int(i) - 1 for i in corner.split("/")[:2]) for corner in word[1:4]])
    sums, normals = [[0, 0, 0] for _ in positions], []
    for face in faces:
        a, b, c = (positions[p] for p, _ in face)
        u, v = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
        n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        normals.append(unit(n))
        for p, _ in face:
            sums[p] = [x + y for x, y in zip(sums[p], n)]
    index = {}
    triangles = [[index.setdefault(corner, len(index)) for corner in face] for face in faces]
    words = []
    for p in positions:
        words += [round(32768 * x / HALF) for x in p]
    for n in sums:
        words += unit(n)
    for p, t in index:
        u, v = (round(65536 * x) for x in uvs[t])
        words += [p, u, u >> 16, v, v >> 16]
    for triangle in triangles:
        words += triangle
    for n in normals:
        words += n
    words += texture(picture)
    print(len(positions), "positions,", len(index), "vertices,", len(faces), "faces")
    open(out, "wb").write(b"".join(struct.pack("<H", w & 65535) for w in words))


main(*sys.argv[1:])
