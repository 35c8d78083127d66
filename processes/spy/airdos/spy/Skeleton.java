package airdos.spy;

import airdos.person_keypoints_t;
import java.util.Arrays;

/** The body model of lcmtypes/README.md: 14 joints in COCO-18 order and the 14 segments. */
final class Skeleton {
  static final int NUM_JOINTS = 14;

  /** Pairs of joint numbers. */
  static final int[][] SEGMENTS = {
    {1, 2}, {1, 5}, {2, 8}, {5, 11}, {8, 11}, {2, 3}, {3, 4},
    {5, 6}, {6, 7}, {8, 9}, {9, 10}, {11, 12}, {12, 13}, {1, 0}
  };

  /** Row: joint 0..13; value: its index in COCO-17 and in the first 17 of Halpe-26. */
  private static final int[] FROM_COCO17 = {0, -1, 6, 8, 10, 5, 7, 9, 12, 14, 16, 11, 13, 15};

  private static final int HALPE26_NECK = 18;

  private Skeleton() {}

  /**
   * Pixels of one person's body joints as {u, v}; null for a joint that was not seen. All are
   * null if the layout is unknown or the message is too short for it.
   */
  static float[][] jointsPx(person_keypoints_t message, int person) {
    float[][] joints = new float[NUM_JOINTS][];
    for (int joint = 0; joint < NUM_JOINTS; ++joint) {
      int index = indexOf(joint, message.layout);
      if (index >= 0) joints[joint] = pixelOf(message, person, index);
    }
    if (message.layout == person_keypoints_t.LAYOUT_COCO17) {
      float[] right = joints[2];
      float[] left = joints[5];
      if (right != null && left != null) {
        joints[1] = new float[] {(right[0] + left[0]) / 2, (right[1] + left[1]) / 2};
      }
    }
    return joints;
  }

  private static int indexOf(int joint, byte layout) {
    switch (layout) {
      case person_keypoints_t.LAYOUT_COCO18:
        return joint;
      case person_keypoints_t.LAYOUT_COCO17:
        return FROM_COCO17[joint];
      case person_keypoints_t.LAYOUT_HALPE26:
        return joint == 1 ? HALPE26_NECK : FROM_COCO17[joint];
      default:
        return -1;
    }
  }

  private static float[] pixelOf(person_keypoints_t message, int person, int index) {
    if (index >= message.num_joints || !(message.confidence[person][index] > 0)) return null;
    float[] pixel = {message.u_px[person][index], message.v_px[person][index]};
    return Float.isFinite(pixel[0]) && Float.isFinite(pixel[1]) ? pixel : null;
  }

  /** The same for joints given by number, as in human_observation_t. */
  static float[][] jointsPx(byte[] ids, float[] u, float[] v) {
    float[][] joints = new float[NUM_JOINTS][];
    for (int i = 0; i < ids.length; ++i) {
      if (ids[i] < 0 || ids[i] >= NUM_JOINTS) continue;
      if (Float.isFinite(u[i]) && Float.isFinite(v[i])) joints[ids[i]] = new float[] {u[i], v[i]};
    }
    return joints;
  }

  /** The topmost visible joint, where the label goes; or null. */
  static float[] topOf(float[][] joints) {
    return Arrays.stream(joints)
        .filter(joint -> joint != null)
        .min((a, b) -> Float.compare(a[1], b[1]))
        .orElse(null);
  }
}
