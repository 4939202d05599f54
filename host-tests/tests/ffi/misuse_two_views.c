/* Every misuse of the functions on matches has its status, and leaves everything else as it was. Ends with the number of
   failures; built as misuse.c is. */
#include "check.h"

enum { COUNT = 40 };

static const stereopsis_pinhole camera = {300.0f, 300.0f, 160.0f, 120.0f};

/* Matches of points at different depths, seen by a camera that stands 0.2 to the right and 0.05 ahead. */
static void see(stereopsis_match *matches) {
    for (int i = 0; i < COUNT; i++) {
        float x = (float)(i * 17 % 41) / 20.0f - 1.0f, y = (float)(i * 11 % 41) / 30.0f - 0.7f;
        float z = 2.0f + (float)(i * 7 % 41) / 15.0f;
        matches[i].u = 300.0f * x / z + 160.0f, matches[i].v = 300.0f * y / z + 120.0f;
        matches[i].u2 = 300.0f * (x - 0.2f) / (z - 0.05f) + 160.0f, matches[i].v2 = 300.0f * y / (z - 0.05f) + 120.0f;
    }
}

static void fundamentals(stereopsis_match *matches, float *f, uint8_t *inliers) {
    guarded all = guard(COUNT * sizeof(stereopsis_match));
    stereopsis_agreement agreement;
    memcpy(all.memory, matches, all.size);
    matches = (stereopsis_match *)(void *)all.memory;
    EXPECT(stereopsis_eight_point(NULL, COUNT, f), NULL);
    EXPECT(stereopsis_eight_point(matches, COUNT, NULL), NULL);
    EXPECT(stereopsis_eight_point((stereopsis_match *)MISALIGN(matches), COUNT, f), MISALIGNED);
    EXPECT(stereopsis_eight_point(matches, COUNT, (float *)MISALIGN(f)), MISALIGNED);
    EXPECT(stereopsis_eight_point(matches, SIZE_MAX, f), TOO_MANY);
    EXPECT(stereopsis_eight_point(matches, 0, f), TOO_FEW_MATCHES);
    EXPECT(stereopsis_eight_point(matches, COUNT, f), OK);

    EXPECT(stereopsis_fundamental(NULL, COUNT, 1.0f, 0, f, inliers, &agreement), NULL);
    EXPECT(stereopsis_fundamental(matches, COUNT, 1.0f, 0, NULL, inliers, &agreement), NULL);
    EXPECT(stereopsis_fundamental(matches, COUNT, 1.0f, 0, f, NULL, &agreement), NULL);
    EXPECT(stereopsis_fundamental(matches, COUNT, 1.0f, 0, f, inliers, NULL), NULL);
    EXPECT(stereopsis_fundamental(matches, SIZE_MAX, 1.0f, 0, f, inliers, &agreement), TOO_MANY);
    EXPECT(stereopsis_fundamental(matches, 7, 1.0f, 0, f, inliers, &agreement), TOO_FEW_MATCHES);
    EXPECT(stereopsis_fundamental(matches, COUNT, 0.0f, 0, f, inliers, &agreement), MATCH_THRESHOLD);
    EXPECT(stereopsis_fundamental(matches, COUNT, 1.0f, 0, f, all.memory, &agreement), OVERLAP);
    EXPECT(stereopsis_fundamental(matches, COUNT, 1.0f, 0, (float *)matches, inliers, &agreement), OVERLAP);
    EXPECT(stereopsis_fundamental(matches, COUNT, 1.0f, 0, f, (uint8_t *)f, &agreement), OVERLAP);
    EXPECT(stereopsis_fundamental(matches, COUNT, 1.0f, 0, f, (uint8_t *)&agreement, &agreement), OVERLAP);
    EXPECT(stereopsis_fundamental(matches, COUNT, 1.0f, 0, f, inliers, (stereopsis_agreement *)(void *)&f[6]), OVERLAP);
    EXPECT(stereopsis_fundamental(matches, COUNT, 1.0f, 0, f, inliers, (stereopsis_agreement *)MISALIGN(&agreement)), MISALIGNED);
    EXPECT(stereopsis_fundamental(matches, COUNT, 1.0f, 0, f, inliers, &agreement), OK);
    CHECK(agreement.inliers == COUNT && agreement.rms_px < 0.01f);
    for (int i = 0; i < COUNT; i++) CHECK(inliers[i] == 1);
    volatile float zero = 0.0f;
    stereopsis_match kept = matches[COUNT - 1];
    matches[COUNT - 1].v2 = 1.0f / zero;
    EXPECT(stereopsis_eight_point(matches, COUNT, f), MATCH_NOT_FINITE);
    EXPECT(stereopsis_fundamental(matches, COUNT, 1.0f, 0, f, inliers, &agreement), MATCH_NOT_FINITE);
    matches[COUNT - 1] = kept;
    /* Rows that have nothing to do with each other, and one match many times. */
    uint32_t random = 1;
    for (int i = 0; i < COUNT; i++) {
        random = random * 1664525u + 1013904223u;
        matches[i].u2 = (float)(random >> 23), matches[i].v2 = (float)(random >> 15 & 255u);
    }
    EXPECT(stereopsis_fundamental(matches, COUNT, 0.001f, 0, f, inliers, &agreement), MATCHES_DISAGREE);
    for (int i = 0; i < COUNT; i++) matches[i] = kept;
    EXPECT(stereopsis_eight_point(matches, COUNT, f), MATCHES_DEGENERATE);
    see(matches);
    for (int i = 0; i < COUNT; i++) matches[i].u2 = matches[i].u + 9.0f, matches[i].v2 = matches[i].v;
    EXPECT(stereopsis_fundamental(matches, COUNT, 1.0f, 0, f, inliers, &agreement), MATCHES_ON_PLANE);
    release(all);
}

static void poses(const stereopsis_match *matches, const float *f, const uint8_t *inliers) {
    stereopsis_pose pose;
    stereopsis_point points[COUNT];
    stereopsis_pinhole none = camera;
    float zeros[9] = {0};
    none.fy = 0.0f;
    EXPECT(stereopsis_pose_of(NULL, inliers, COUNT, f, &camera, &camera, &pose), NULL);
    EXPECT(stereopsis_pose_of(matches, inliers, COUNT, NULL, &camera, &camera, &pose), NULL);
    EXPECT(stereopsis_pose_of(matches, inliers, COUNT, f, NULL, &camera, &pose), NULL);
    EXPECT(stereopsis_pose_of(matches, inliers, COUNT, f, &camera, NULL, &pose), NULL);
    EXPECT(stereopsis_pose_of(matches, inliers, COUNT, f, &camera, &camera, NULL), NULL);
    EXPECT(stereopsis_pose_of(matches, inliers, SIZE_MAX, f, &camera, &camera, &pose), TOO_MANY);
    EXPECT(stereopsis_pose_of(matches, inliers, COUNT, zeros, &camera, &camera, &pose), FUNDAMENTAL_RANK);
    EXPECT(stereopsis_pose_of(matches, inliers, COUNT, f, &camera, &none, &pose), PINHOLE_NUMBERS);
    EXPECT(stereopsis_pose_of(matches, inliers, 0, f, &camera, &camera, &pose), POSE_AMBIGUOUS);
    EXPECT(stereopsis_pose_of(matches, NULL, COUNT, f, &camera, &camera, &pose), OK);
    EXPECT(stereopsis_pose_of(matches, inliers, COUNT, f, &camera, &camera, &pose), OK);
    CHECK(pose.rotation[0] > 0.999f && pose.translation[0] > 0.96f && pose.translation[2] > 0.2f);

    EXPECT(stereopsis_triangulate(NULL, COUNT, &camera, &camera, &pose, points), NULL);
    EXPECT(stereopsis_triangulate(matches, COUNT, NULL, &camera, &pose, points), NULL);
    EXPECT(stereopsis_triangulate(matches, COUNT, &camera, NULL, &pose, points), NULL);
    EXPECT(stereopsis_triangulate(matches, COUNT, &camera, &camera, NULL, points), NULL);
    EXPECT(stereopsis_triangulate(matches, COUNT, &camera, &camera, &pose, NULL), NULL);
    EXPECT(stereopsis_triangulate(matches, SIZE_MAX, &camera, &camera, &pose, points), TOO_MANY);
    EXPECT(stereopsis_triangulate(matches, COUNT, &none, &camera, &pose, points), PINHOLE_NUMBERS);
    EXPECT(stereopsis_triangulate(matches, COUNT, &camera, &camera, &pose, points), OK);
    /* Lengths in baselines of 0.206. */
    for (int i = 0; i < COUNT; i++) CHECK(points[i].z_m > 9.0f && points[i].z_m < 24.0f);
    pose.rotation[4] = 3.0f;
    EXPECT(stereopsis_triangulate(matches, COUNT, &camera, &camera, &pose, points), POSE_NUMBERS);
}

int main(void) {
    stereopsis_match matches[COUNT];
    float f[9];
    uint8_t inliers[COUNT];
    see(matches);
    fundamentals(matches, f, inliers);
    /* The last call flagged what is on the plane, and left F. */
    memset(inliers, 1, COUNT);
    poses(matches, f, inliers);
    printf("%d failures\n", failures);
    return failures > 0;
}
