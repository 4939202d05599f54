"""OpenCV's matchers on pairs of grey images, for `stereo eval --opencv` and `cargo xtask altered`.

    opencv.py FOLDER SCENE DISPARITIES LEAST [SCENE DISPARITIES LEAST ...]

Reads FOLDER/SCENE-left.pgm and -right.pgm, writes FOLDER/SCENE-StereoBM.pfm and -StereoSGBM.pfm: px, infinite where
there is no answer. LEAST is the smallest disparity. One thread. What is not given has OpenCV's defaults.
"""

import sys

import cv2
import numpy as np


def stereo_bm(disparities, least):
    matcher = cv2.StereoBM_create(numDisparities=disparities, blockSize=9)
    matcher.setMinDisparity(least)
    return matcher


def stereo_sgbm(disparities, least):
    window = 3
    return cv2.StereoSGBM_create(
        minDisparity=least, numDisparities=disparities, blockSize=window,
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
    for scene, disparities, least in zip(words[::3], map(int, words[1::3]), map(int, words[2::3])):
        left, right = (cv2.imread(f"{folder}/{scene}-{side}.pgm", cv2.IMREAD_GRAYSCALE) for side in ("left", "right"))
        # Only multiples of 16 are searched.
        searched = (disparities + 15) // 16 * 16
        for name, make in (("StereoBM", stereo_bm), ("StereoSGBM", stereo_sgbm)):
            # In 1/16 px, below the smallest one where there is no answer.
            found = make(searched, least).compute(left, right).astype(np.float32)
            write_pfm(f"{folder}/{scene}-{name}.pfm", np.where(found < 16 * least, np.inf, found / 16))


main(*sys.argv[1:])
