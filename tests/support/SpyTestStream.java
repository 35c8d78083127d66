package airdos.spy;

import airdos.channel_status_t;
import airdos.frame_done_t;
import airdos.frame_pose_t;
import airdos.human_observation_t;
import airdos.human_observations_t;
import airdos.human_state_t;
import airdos.image_t;
import airdos.map_update_t;
import airdos.person_keypoints_t;
import airdos.person_mask_t;
import airdos.pose_t;
import airdos.process_status_t;
import airdos.state_estimate_t;
import airdos.static_features_t;
import airdos.stereo_calibration_t;
import java.awt.Color;
import java.awt.Graphics2D;
import java.awt.image.BufferedImage;
import java.io.ByteArrayOutputStream;
import java.io.IOException;
import java.nio.file.Files;
import java.nio.file.Path;
import java.nio.file.Paths;
import java.util.ArrayList;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.Map;
import javax.imageio.ImageIO;
import lcm.lcm.LCMEncodable;

/**
 * One message of every channel for each image number: a made-up scene of two people, or, given a
 * folder in the TartanAir-Shibuya layout, its left images and keypoints.
 */
final class SpyTestStream {
  static final int WIDTH = 640;
  static final int HEIGHT = 360;
  static final long SESSION = 7;
  static final String FINGERPRINT = "0123456789abcdef";
  static final long FRAME_US = 100_000;
  private static final float TRACKED_FROM_CONFIDENCE = 0.5f;
  private static final double[] UPRIGHT = {1, 0, 0, 0};

  /** A standing person 100 px high, joints 0..13, relative to the neck. */
  private static final float[][] PERSON = {
    {0, -12}, {0, 0}, {-10, 2}, {-14, 20}, {-15, 36}, {10, 2}, {14, 20}, {15, 36},
    {-7, 40}, {-8, 64}, {-8, 86}, {7, 40}, {8, 64}, {8, 86}
  };

  private final Path folder;

  SpyTestStream(String folder) {
    this.folder = folder == null ? null : Paths.get(folder);
  }

  Map<String, LCMEncodable> messagesOf(long seq) throws IOException {
    image_t image = image(seq);
    person_keypoints_t people = folder == null ? madeUpPeople(seq) : readPeople(seq);
    Map<String, LCMEncodable> messages = new LinkedHashMap<>();
    messages.put("CALIBRATION", calibration(seq));
    messages.put("CAMERA_LEFT", image);
    messages.put("CAMERA_RIGHT", image);
    messages.put("PERSON_KEYPOINTS_LEFT", people);
    messages.put("PERSON_KEYPOINTS_RIGHT", people);
    messages.put("PERSON_MASK", mask(seq));
    messages.put("GROUND_TRUTH", groundTruth(seq));
    messages.put("STATIC_FEATURES", features(seq));
    messages.put("HUMAN_OBSERVATIONS", tracks(people));
    messages.put("STATE_ESTIMATE", estimate(seq));
    messages.put("MAP_UPDATE", mapUpdate(seq));
    messages.put("FRAME_DONE", frameDone(seq));
    messages.put("STATUS", status(seq, seq % 2 == 0 ? "frontend" : "human_tracker"));
    return messages;
  }

  image_t image(long seq) throws IOException {
    image_t message = new image_t();
    message.utime = seq * FRAME_US;
    message.seq = seq;
    message.session = SESSION;
    message.width = WIDTH;
    message.height = HEIGHT;
    message.encoding = image_t.ENCODING_JPEG;
    message.data = folder == null
        ? madeUpImage()
        : Files.readAllBytes(folder.resolve(String.format("image_0/%06d.jpg", seq)));
    message.num_bytes = message.data.length;
    return message;
  }

  private static byte[] madeUpImage() throws IOException {
    BufferedImage image = new BufferedImage(WIDTH, HEIGHT, BufferedImage.TYPE_3BYTE_BGR);
    Graphics2D g = image.createGraphics();
    g.setColor(new Color(60, 70, 90));
    g.fillRect(0, 0, WIDTH, HEIGHT);
    g.dispose();
    ByteArrayOutputStream bytes = new ByteArrayOutputStream();
    ImageIO.write(image, "jpg", bytes);
    return bytes.toByteArray();
  }

  person_keypoints_t madeUpPeople(long seq) {
    List<float[][]> people = new ArrayList<>();
    for (float neckPx : new float[] {200, 440}) {
      float[][] joints = new float[18][3];
      for (int joint = 0; joint < PERSON.length; ++joint) {
        float[] pixel = {neckPx + seq % 30 + PERSON[joint][0], 150 + PERSON[joint][1], 0.9f};
        joints[joint] = pixel;
      }
      people.add(joints);
    }
    return keypoints(seq, people);
  }

  private person_keypoints_t readPeople(long seq) throws IOException {
    List<float[][]> people = new ArrayList<>();
    Path file = folder.resolve(String.format("alphapose_0/%06d.txt", seq));
    for (String line : Files.readAllLines(file)) {
      String[] words = line.trim().split("\\s+");
      float[][] joints = new float[18][3];
      for (int i = 0; i < words.length; ++i) joints[i / 3][i % 3] = Float.parseFloat(words[i]);
      people.add(joints);
    }
    return keypoints(seq, people);
  }

  private static person_keypoints_t keypoints(long seq, List<float[][]> people) {
    person_keypoints_t message = new person_keypoints_t();
    message.utime = seq * FRAME_US;
    message.seq = seq;
    message.session = SESSION;
    message.layout = person_keypoints_t.LAYOUT_COCO18;
    message.num_people = people.size();
    message.num_joints = 18;
    message.u_px = new float[people.size()][18];
    message.v_px = new float[people.size()][18];
    message.confidence = new float[people.size()][18];
    for (int person = 0; person < people.size(); ++person) {
      for (int joint = 0; joint < 18; ++joint) {
        message.u_px[person][joint] = people.get(person)[joint][0];
        message.v_px[person][joint] = people.get(person)[joint][1];
        message.confidence[person][joint] = people.get(person)[joint][2];
      }
    }
    return message;
  }

  /** Every person whose neck is clear, but the last, who stays without a track. */
  static human_observations_t tracks(person_keypoints_t people) {
    human_observations_t message = new human_observations_t();
    message.utime = people.utime;
    message.seq = people.seq;
    message.session = people.session;
    message.num_detected_left = people.num_people;
    message.num_detected_right = people.num_people;
    List<human_observation_t> humans = new ArrayList<>();
    for (int person = 0; person + 1 < people.num_people; ++person) {
      if (people.confidence[person][1] < TRACKED_FROM_CONFIDENCE) continue;
      humans.add(track(people, person));
    }
    message.num_humans = humans.size();
    message.humans = humans.toArray(new human_observation_t[0]);
    return message;
  }

  private static human_observation_t track(person_keypoints_t people, int person) {
    float[][] joints = Skeleton.jointsPx(people, person);
    human_observation_t human = new human_observation_t();
    human.track_id = person + 3;
    for (float[] joint : joints) human.num_joints += joint == null ? 0 : 1;
    int n = human.num_joints;
    human.joint_id = new byte[n];
    human.u_left_px = new float[n];
    human.v_left_px = new float[n];
    human.u_right_px = new float[n];
    human.v_right_px = new float[n];
    human.sigma_px = new float[n];
    human.x_C_m = new float[n];
    human.y_C_m = new float[n];
    human.z_C_m = new float[n];
    human.covariance_C = new float[n][6];
    int i = 0;
    for (byte joint = 0; joint < Skeleton.NUM_JOINTS; ++joint) {
      if (joints[joint] == null) continue;
      human.joint_id[i] = joint;
      human.u_left_px[i] = joints[joint][0];
      human.v_left_px[i] = joints[joint][1];
      ++i;
    }
    return human;
  }

  static_features_t features(long seq) {
    static_features_t message = new static_features_t();
    message.utime = seq * FRAME_US;
    message.seq = seq;
    message.session = SESSION;
    message.tracking_state = static_features_t.STATE_TRACKING;
    message.orientation_O_C = UPRIGHT.clone();
    message.orientation_W_C = UPRIGHT.clone();
    message.num_features = 60;
    message.landmark_id = new long[60];
    message.u_left_px = new float[60];
    message.v_px = new float[60];
    message.u_right_px = new float[60];
    message.has_right = new boolean[60];
    message.sigma_px = new float[60];
    for (int i = 0; i < 60; ++i) {
      message.landmark_id[i] = i;
      message.u_left_px[i] = 20 + (i * 103) % 600;
      message.v_px[i] = 20 + (i * 59) % 100;
      message.has_right[i] = i % 5 != 0;
    }
    return message;
  }

  private static stereo_calibration_t calibration(long seq) {
    stereo_calibration_t message = new stereo_calibration_t();
    message.utime = seq * FRAME_US;
    message.seq = seq;
    message.session = SESSION;
    message.width = WIDTH;
    message.height = HEIGHT;
    message.fx_px = message.fy_px = 772.5;
    message.cx_px = WIDTH / 2.0;
    message.cy_px = HEIGHT / 2.0;
    message.baseline_m = 0.25;
    return message;
  }

  private static person_mask_t mask(long seq) {
    person_mask_t message = new person_mask_t();
    message.utime = seq * FRAME_US;
    message.seq = seq;
    message.session = SESSION;
    message.width = WIDTH;
    message.height = HEIGHT;
    message.encoding = person_mask_t.ENCODING_NONE;
    message.data = new byte[0];
    return message;
  }

  private static pose_t groundTruth(long seq) {
    pose_t message = new pose_t();
    message.utime = seq * FRAME_US;
    message.seq = seq;
    message.session = SESSION;
    message.axes = pose_t.AXES_OPTICAL;
    message.orientation = UPRIGHT.clone();
    return message;
  }

  private static state_estimate_t estimate(long seq) {
    state_estimate_t message = new state_estimate_t();
    message.utime = seq * FRAME_US;
    message.seq = seq;
    message.session = SESSION;
    message.status = state_estimate_t.STATUS_CONVERGED;
    message.trusted = state_estimate_t.TRUSTED_WITHOUT_PEOPLE;
    message.position_W_C = new double[] {0.1 * seq, 0, 0};
    message.orientation_W_C = UPRIGHT.clone();
    message.orientation_with_people_W_C = UPRIGHT.clone();
    message.orientation_without_people_W_C = UPRIGHT.clone();
    return message;
  }

  private static map_update_t mapUpdate(long seq) {
    map_update_t message = new map_update_t();
    message.utime = seq * FRAME_US;
    message.seq = seq;
    message.session = SESSION;
    message.num_parts = 1;
    message.frames = new frame_pose_t[0];
    message.landmark_id = new long[0];
    message.x_W_m = new double[0];
    message.y_W_m = new double[0];
    message.z_W_m = new double[0];
    message.sigma_m = new float[0];
    message.num_observations = new int[0];
    message.removed_landmark_id = new long[0];
    message.humans = new human_state_t[0];
    message.repeated_landmark_id = new long[0];
    message.repeated_x_W_m = new double[0];
    message.repeated_y_W_m = new double[0];
    message.repeated_z_W_m = new double[0];
    message.repeated_sigma_m = new float[0];
    message.repeated_num_observations = new int[0];
    return message;
  }

  private static frame_done_t frameDone(long seq) {
    frame_done_t message = new frame_done_t();
    message.utime = seq * FRAME_US;
    message.seq = seq;
    message.session = SESSION;
    message.process = "optimizer";
    return message;
  }

  static process_status_t status(long seq, String process) {
    process_status_t message = new process_status_t();
    message.utime = seq * FRAME_US;
    message.seq = seq;
    message.session = SESSION;
    message.process = process;
    message.version = "test";
    message.types_fingerprint = FINGERPRINT;
    message.state = process.equals("frontend")
        ? process_status_t.STATE_READY
        : process_status_t.STATE_STALLED;
    message.num_frames_done = seq;
    message.latency_p50_ms = 21.5;
    message.latency_p99_ms = 44.25;
    message.waiting_for = process.equals("frontend") ? "" : "PERSON_KEYPOINTS_RIGHT";
    message.last_error = "";
    message.num_warnings = 2;
    message.warnings = new String[] {"times go back", "the images are not rectified"};
    channel_status_t channel = new channel_status_t();
    channel.channel = "CAMERA_LEFT";
    channel.num_received = seq;
    channel.num_rejected = 2;
    channel.last_reject = "does not decode";
    message.num_channels = 1;
    message.channels = new channel_status_t[] {channel};
    return message;
  }
}
