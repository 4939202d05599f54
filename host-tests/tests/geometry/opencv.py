#!/usr/bin/env python3
"""OpenCV's eight points on the scenes of `noise_costs_no_more_than_it_costs_opencv` in estimates.rs.

    pip install numpy opencv-contrib-python-headless
    python3 opencv.py

The scenes are made here as `Views::scene` and `noisy` of the host package make them: the same stream of random
numbers, 60 seeds for each number of correspondences, 0.5 px of noise. Printed is the mean over the scenes of the
root mean square Sampson distance of the exact points, px: the constant OPENCV of that test.
"""

import math

import cv2
import numpy as np

MASK = (1 << 64) - 1


class Random:
    """SplitMix64, as in src/scene/random.rs."""

    def __init__(self, seed):
        self.state = seed

    def unit(self):
        self.state = (self.state + 0x9E3779B97F4A7C15) & MASK
        z = self.state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
        return ((z ^ (z >> 31)) >> 11) / (1 << 53)

    def number(self, size):
        return size * (2.0 * self.unit() - 1.0)

    def gauss(self):
        radius = math.sqrt(-2.0 * math.log(1.0 - self.unit()))
        return radius * math.cos(math.tau * self.unit())


def scene(seed, count):
    """Points 4 to 10 m away in two images of 640 x 480 pixels."""
    random = Random(seed)
    axis = np.array([random.number(0.1) for _ in range(3)])
    rotation = cv2.Rodrigues(axis)[0]
    translation = np.array([0.5 + random.number(0.1), random.number(0.1), random.number(0.2)])

    def project(point):
        return np.array([600.0 * point[0] / point[2] + 320.0, 600.0 * point[1] / point[2] + 240.0])

    def inside(pixel):
        return 0.0 <= pixel[0] < 640.0 and 0.0 <= pixel[1] < 480.0

    first, second = [], []
    while len(first) < count:
        point = np.array([random.number(3.0), random.number(2.0), 7.0 + random.number(3.0)])
        p, q = project(point), project(rotation.T @ (point - translation))
        if inside(p) and inside(q):
            first.append(p)
            second.append(q)
    return np.array(first), np.array(second)


def noisy(first, second, sigma, seed):
    random = Random(seed ^ 0x5EED)
    off = [[sigma * random.gauss() for _ in range(4)] for _ in first]
    off = np.array(off)
    return first + off[:, :2], second + off[:, 2:]


def rms_sampson(f, first, second):
    """`f` as OpenCV writes it: second^T F first = 0."""
    one = np.ones((len(first), 1))
    p, q = np.hstack([first, one]), np.hstack([second, one])
    in_second, in_first = p @ f.T, q @ f
    residual = np.sum(q * in_second, axis=1)
    gradient = np.sum(in_second[:, :2] ** 2, axis=1) + np.sum(in_first[:, :2] ** 2, axis=1)
    return math.sqrt(np.mean(residual**2 / gradient))


def main():
    print(f"OpenCV {cv2.__version__}")
    for count in (8, 20, 50, 200):
        errors = []
        for seed in range(60):
            first, second = scene(seed, count)
            f, _ = cv2.findFundamentalMat(*noisy(first, second, 0.5, seed), cv2.FM_8POINT)
            errors.append(rms_sampson(f, first, second))
        print(f"{count:4} correspondences: {np.mean(errors):.6f} px")


if __name__ == "__main__":
    main()
