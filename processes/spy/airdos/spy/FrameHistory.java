package airdos.spy;

import airdos.human_observations_t;
import airdos.image_t;
import airdos.person_keypoints_t;
import airdos.static_features_t;
import java.io.IOException;
import java.util.Map;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMSubscriber;

/**
 * Joins the left image with keypoints, people and features of the same image number. Messages
 * arrive on LCM's thread; the frame is requested on Swing's.
 */
final class FrameHistory implements LCMSubscriber {
  static final String IMAGE = "CAMERA_LEFT";
  static final String KEYPOINTS = "PERSON_KEYPOINTS_LEFT";
  static final String HUMANS = "HUMAN_OBSERVATIONS";
  static final String FEATURES = "STATIC_FEATURES";
  static final String[] CHANNELS = {IMAGE, KEYPOINTS, HUMANS, FEATURES};

  /** How many images the view may lag behind the camera while waiting for a slow process. */
  static final long MAX_LAG = 10;

  private final SeqBuffer<image_t> images = new SeqBuffer<>();
  private final SeqBuffer<person_keypoints_t> keypoints = new SeqBuffer<>();
  private final SeqBuffer<human_observations_t> humans = new SeqBuffer<>();
  private final SeqBuffer<static_features_t> features = new SeqBuffer<>();
  private long numUndecodable;

  @Override
  public void messageReceived(LCM lcm, String channel, LCMDataInputStream stream) {
    try {
      add(channel, stream);
    } catch (IOException | RuntimeException e) {
      // Whatever the bytes were (the generated decode() throws all kinds of exceptions), the spy
      // continues.
      synchronized (this) {
        ++numUndecodable;
      }
    }
  }

  private void add(String channel, LCMDataInputStream stream) throws IOException {
    switch (channel) {
      case IMAGE:
        add(new image_t(stream));
        break;
      case KEYPOINTS:
        add(new person_keypoints_t(stream));
        break;
      case HUMANS:
        add(new human_observations_t(stream));
        break;
      case FEATURES:
        add(new static_features_t(stream));
        break;
      default:
        break;
    }
  }

  synchronized void add(image_t message) {
    images.add(message.session, message.seq, message);
  }

  synchronized void add(person_keypoints_t message) {
    keypoints.add(message.session, message.seq, message);
  }

  synchronized void add(human_observations_t message) {
    humans.add(message.session, message.seq, message);
  }

  synchronized void add(static_features_t message) {
    features.add(message.session, message.seq, message);
  }

  synchronized long numUndecodable() {
    return numUndecodable;
  }

  /**
   * The newest image for which every process active in this session has published. If one of them
   * has fallen silent, the image MAX_LAG before the newest, with whatever there is. Null before
   * the first image.
   */
  synchronized Frame newest() {
    if (images.isEmpty()) return null;
    long newestSeq = images.newestSeq();
    for (long lag = 0; lag <= MAX_LAG; ++lag) {
      image_t image = images.get(images.session(), newestSeq - lag);
      if (image == null) continue;
      Frame frame = frameOf(image);
      if (isComplete(frame)) return frame;
    }
    Map.Entry<Long, image_t> late = images.atOrBefore(newestSeq - MAX_LAG);
    return late == null ? null : frameOf(late.getValue());
  }

  private Frame frameOf(image_t image) {
    return new Frame(
        image,
        keypoints.get(image.session, image.seq),
        humans.get(image.session, image.seq),
        features.get(image.session, image.seq));
  }

  private boolean isComplete(Frame frame) {
    return (frame.keypoints != null || !speaks(keypoints))
        && (frame.humans != null || !speaks(humans))
        && (frame.features != null || !speaks(features));
  }

  private boolean speaks(SeqBuffer<?> buffer) {
    return !buffer.isEmpty() && buffer.session() == images.session();
  }
}
