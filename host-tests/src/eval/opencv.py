"""OpenCV's matchers on pairs of grey images: their columns in the table of `cargo xtask altered`.

    opencv.py FOLDER SCENE DISPARITIES [SCENE DISPARITIES ...]

Reads FOLDER/SCENE-left.pgm and -right.pgm, writes FOLDER/SCENE-StereoBM.pfm and -StereoSGBM.pfm: px, infinite where
there is no answer. Prints OpenCV's version. One thread. What is not given has OpenCV's defaults.
"""

import sys

import cv2
import numpy as np


def stereo_bm(disparities):
    return cv2.StereoBM_create(disparities, 9)


def stereo_sgbm(disparities):
    window = 3
    return cv2.StereoSGBM_create(
        minDisparity=0, numDisparities=disparities, blockSize=window,
        # What OpenCV's documentation proposes for one channel.
        P1=8 * window**2, P2=32 * window**2, disp12MaxDiff=1, uniquenessRatio=10,
        speckleWindowSize=100, speckleRange=2, mode=cv2.STEREO_SGBM_MODE_SGBM_3WAY)


def write_pfm(path, values):
    height, width = values.shape
    with open(path, "wb") as file:
        file.write(f"Pf\n{width} {height}\n-1\n".encode())
        file.write(values[::-1].astype("<f4").tobytes())


def main(folder, *words):
    cv2.setNumThreads(1)
    for scene, disparities in zip(words[::2], map(int, words[1::2])):
        left, right = (cv2.imread(f"{folder}/{scene}-{side}.pgm", cv2.IMREAD_GRAYSCALE) for side in ("left", "right"))
        # Only multiples of 16 are searched.
        searched = (disparities + 15) // 16 * 16
        for name, make in (("StereoBM", stereo_bm), ("StereoSGBM", stereo_sgbm)):
            # In 1/16 px, negative where there is no answer.
            found = make(searched).compute(left, right).astype(np.float32)
            write_pfm(f"{folder}/{scene}-{name}.pfm", np.where(found < 0, np.inf, found / 16))
    print(cv2.__version__)


main(*sys.argv[1:])
