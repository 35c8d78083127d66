package airdos.spy;

import airdos.human_observations_t;
import airdos.image_t;
import airdos.person_keypoints_t;
import airdos.static_features_t;
import java.util.ArrayList;
import java.util.List;

/** All messages about one image. Everything but the image may be null if it has not arrived. */
final class Frame {
  final image_t image;
  final person_keypoints_t keypoints;
  final human_observations_t humans;
  final static_features_t features;

  Frame(
      image_t image,
      person_keypoints_t keypoints,
      human_observations_t humans,
      static_features_t features) {
    this.image = image;
    this.keypoints = keypoints;
    this.humans = humans;
    this.features = features;
  }

  List<String> missingChannels() {
    List<String> missing = new ArrayList<>();
    if (keypoints == null) missing.add(FrameHistory.KEYPOINTS);
    if (humans == null) missing.add(FrameHistory.HUMANS);
    if (features == null) missing.add(FrameHistory.FEATURES);
    return missing;
  }
}
