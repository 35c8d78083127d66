package airdos.spy;

import airdos.human_observations_t;
import airdos.image_t;
import airdos.person_keypoints_t;
import airdos.process_status_t;
import airdos.static_features_t;
import java.awt.Color;
import java.awt.Graphics2D;
import java.awt.image.BufferedImage;
import java.util.Arrays;
import java.util.List;
import java.util.TreeSet;
import lcm.lcm.LCMDataInputStream;
import lcm.spy.SpyPlugin;
import lcm.util.ClassDiscoverer;

/** What the plugins draw and show, without a display. Exits with 1 at the first wrong thing. */
final class SpyRendererTest {
  private static final int TWICE_WIDTH = 2 * SpyTestStream.WIDTH;
  private static final int TWICE_HEIGHT = 2 * SpyTestStream.HEIGHT + FrameRenderer.TEXT_HEIGHT;

  private SpyRendererTest() {}

  private static void check(boolean condition, String what) {
    if (condition) return;
    System.err.println("FAILED: " + what);
    System.exit(1);
  }

  public static void main(String[] args) throws Exception {
    pluginsAreDiscoveredAsTheSpyDoesIt();
    featuresAndPeopleAreDrawnWhereTheyWereSeen();
    segmentsAreThoseOfTheChannelTable();
    allLayoutsGiveTheSameJoints();
    imagesOfEveryEncodingAreShown();
    framesAreJoinedByImageNumber();
    viewWaitsForSlowProcessesButNotForEver();
    restartOfTheSourceIsFollowed();
    badBytesAreCounted();
    statusTableNamesWhoIsStalledAndSilent();
    System.out.println("all checks passed");
  }

  private static void pluginsAreDiscoveredAsTheSpyDoesIt() {
    TreeSet<String> handlersOfImages = new TreeSet<>();
    TreeSet<String> handlersOfStatus = new TreeSet<>();
    ClassDiscoverer.findClasses(
        (jar, cls) -> {
          if (!Arrays.asList(cls.getInterfaces()).contains(SpyPlugin.class)) return;
          try {
            SpyPlugin plugin = (SpyPlugin) ((Class<?>) cls).getConstructor().newInstance();
            String name = (String) plugin.getAction(null, null).getValue("Name");
            if (plugin.canHandle(image_t.LCM_FINGERPRINT)) handlersOfImages.add(name);
            if (plugin.canHandle(process_status_t.LCM_FINGERPRINT)) handlersOfStatus.add(name);
          } catch (ReflectiveOperationException e) {
            check(false, "plugin " + cls + ": " + e);
          }
        });
    check(handlersOfImages.toString().equals("[" + CameraPlugin.NAME + "]"),
        "one plugin for images, not " + handlersOfImages);
    check(handlersOfStatus.toString().equals("[" + StatusPlugin.NAME + "]"),
        "one plugin for STATUS, not " + handlersOfStatus);
  }

  private static BufferedImage draw(Frame frame) {
    BufferedImage canvas =
        new BufferedImage(TWICE_WIDTH, TWICE_HEIGHT, BufferedImage.TYPE_INT_RGB);
    Graphics2D g = canvas.createGraphics();
    new FrameRenderer().paint(g, frame, TWICE_WIDTH, TWICE_HEIGHT);
    g.dispose();
    return canvas;
  }

  /** The colour in the canvas of twice the size at the centre of a pixel of the image. */
  private static Color at(BufferedImage canvas, double u, double v) {
    return new Color(canvas.getRGB((int) (2 * (u + 0.5)), (int) (2 * (v + 0.5))));
  }

  private static boolean isClose(Color a, Color b) {
    return Math.abs(a.getRed() - b.getRed()) < 12 && Math.abs(a.getGreen() - b.getGreen()) < 12
        && Math.abs(a.getBlue() - b.getBlue()) < 12;
  }

  private static void featuresAndPeopleAreDrawnWhereTheyWereSeen() throws Exception {
    SpyTestStream stream = new SpyTestStream(null);
    image_t image = stream.image(4);
    person_keypoints_t people = stream.madeUpPeople(4);
    human_observations_t humans = SpyTestStream.tracks(people);
    static_features_t features = stream.features(4);
    check(humans.num_humans == 1, "the test's scene has one tracked person");

    BufferedImage bare = draw(new Frame(image, null, null, null));
    BufferedImage full = draw(new Frame(image, people, humans, features));
    for (int i = 0; i < features.num_features; ++i) {
      Color expected =
          features.has_right[i] ? FrameRenderer.STEREO_FEATURE : FrameRenderer.MONO_FEATURE;
      Color drawn = at(full, features.u_left_px[i], features.v_px[i]);
      check(isClose(drawn, expected), "feature " + i + " is " + drawn);
      Color below = at(bare, features.u_left_px[i], features.v_px[i]);
      check(isClose(below, new Color(60, 70, 90)), "the image below feature " + i + " is " + below);
    }
    Color[] expected = {FrameRenderer.colourOf(humans.humans[0].track_id), FrameRenderer.UNTRACKED};
    for (int person = 0; person < 2; ++person) {
      for (int joint = 0; joint < Skeleton.NUM_JOINTS; ++joint) {
        Color drawn = at(full, people.u_px[person][joint], people.v_px[person][joint]);
        check(isClose(drawn, expected[person]),
            "joint " + joint + " of person " + person + " is " + drawn);
      }
      for (int[] segment : Skeleton.SEGMENTS) {
        double u = (people.u_px[person][segment[0]] + people.u_px[person][segment[1]]) / 2;
        double v = (people.v_px[person][segment[0]] + people.v_px[person][segment[1]]) / 2;
        Color drawn = at(full, u, v);
        check(isClose(drawn, expected[person]),
            "segment " + Arrays.toString(segment) + " of person " + person + " is " + drawn);
      }
    }
    check(!isClose(FrameRenderer.colourOf(3), FrameRenderer.colourOf(4)), "tracks look different");
    String summary = FrameRenderer.summary(new Frame(image, people, humans, features));
    check(summary.equals("seq 4   t 0.400 s   camera TRACKING   features 60   "
        + "people detected 2, tracked 1"), "summary: " + summary);
  }

  /** Against lcmtypes/README.md, by the names there. */
  private static void segmentsAreThoseOfTheChannelTable() {
    List<String> joints = Arrays.asList("nose", "neck",
        "right shoulder", "right elbow", "right wrist", "left shoulder", "left elbow", "left wrist",
        "right hip", "right knee", "right ankle", "left hip", "left knee", "left ankle");
    String[][] table = {
      {"neck", "right shoulder"}, {"neck", "left shoulder"}, {"right shoulder", "right hip"},
      {"left shoulder", "left hip"}, {"right hip", "left hip"}, {"right shoulder", "right elbow"},
      {"right elbow", "right wrist"}, {"left shoulder", "left elbow"}, {"left elbow", "left wrist"},
      {"right hip", "right knee"}, {"right knee", "right ankle"}, {"left hip", "left knee"},
      {"left knee", "left ankle"}, {"neck", "nose"}
    };
    check(Skeleton.SEGMENTS.length == table.length, "14 segments");
    for (int i = 0; i < table.length; ++i) {
      int[] expected = {joints.indexOf(table[i][0]), joints.indexOf(table[i][1])};
      check(Arrays.equals(Skeleton.SEGMENTS[i], expected), "segment " + i);
    }
  }

  private static void allLayoutsGiveTheSameJoints() {
    int[] coco17 = {0, 0, 6, 8, 10, 5, 7, 9, 12, 14, 16, 11, 13, 15};
    person_keypoints_t message = new person_keypoints_t();
    message.num_people = 1;
    for (int numJoints : new int[] {17, 26}) {
      message.layout = numJoints == 17
          ? person_keypoints_t.LAYOUT_COCO17 : person_keypoints_t.LAYOUT_HALPE26;
      message.num_joints = numJoints;
      message.u_px = new float[1][numJoints];
      message.v_px = new float[1][numJoints];
      message.confidence = new float[1][numJoints];
      for (int i = 0; i < numJoints; ++i) {
        message.u_px[0][i] = 10 * i;
        message.confidence[0][i] = 1;
      }
      float[][] joints = Skeleton.jointsPx(message, 0);
      for (int joint = 0; joint < Skeleton.NUM_JOINTS; ++joint) {
        // COCO-17 has no neck: half-way between its shoulders 5 and 6; Halpe-26 has it at 18.
        float expected = joint != 1 ? 10 * coco17[joint] : numJoints == 17 ? 55 : 180;
        check(joints[joint][0] == expected, numJoints + " joints: joint " + joint);
      }
    }
    message.confidence[0][0] = 0;
    check(Skeleton.jointsPx(message, 0)[0] == null, "confidence 0 is not seen");
    message.layout = 99;
    check(Skeleton.topOf(Skeleton.jointsPx(message, 0)) == null, "unknown layout draws nothing");
  }

  private static void imagesOfEveryEncodingAreShown() {
    image_t message = new image_t();
    message.width = 2;
    message.height = 1;
    message.encoding = image_t.ENCODING_RAW_GRAY8;
    message.data = new byte[] {0, (byte) 255};
    BufferedImage gray = FrameRenderer.decode(message);
    check(gray.getRGB(0, 0) == 0xFF000000 && gray.getRGB(1, 0) == 0xFFFFFFFF, "raw gray");
    message.encoding = image_t.ENCODING_RAW_BGR8;
    check(FrameRenderer.decode(message) == null, "too few bytes for raw colour");
    message.data = new byte[] {(byte) 255, 0, 0, 0, 0, (byte) 255};
    BufferedImage colour = FrameRenderer.decode(message);
    check(colour.getRGB(0, 0) == 0xFF0000FF && colour.getRGB(1, 0) == 0xFFFF0000, "blue first");
    message.encoding = image_t.ENCODING_JPEG;
    check(FrameRenderer.decode(message) == null, "no JPEG");
    draw(new Frame(message, null, null, null));
    draw(null);
  }

  private static void framesAreJoinedByImageNumber() throws Exception {
    SpyTestStream stream = new SpyTestStream(null);
    FrameHistory history = new FrameHistory();
    check(history.newest() == null, "no frame before the first image");
    history.add(stream.image(0));
    check(history.newest().image.seq == 0, "an image alone is shown while nobody else speaks");
    history.add(stream.features(0));
    history.add(stream.image(1));
    Frame frame = history.newest();
    check(frame.image.seq == 0 && frame.features.seq == 0, "waits for the features of image 1");
    history.add(stream.features(1));
    history.add(stream.madeUpPeople(0));
    check(history.newest().image.seq == 0, "waits for the people of image 1");
    history.add(stream.madeUpPeople(1));
    frame = history.newest();
    check(frame.image.seq == 1 && frame.features.seq == 1 && frame.keypoints.seq == 1, "joined");
    check(frame.missingChannels().toString().equals("[HUMAN_OBSERVATIONS]"), "names the silent");
  }

  private static void viewWaitsForSlowProcessesButNotForEver() throws Exception {
    SpyTestStream stream = new SpyTestStream(null);
    FrameHistory history = new FrameHistory();
    history.add(stream.features(0));
    for (long seq = 0; seq <= FrameHistory.MAX_LAG; ++seq) history.add(stream.image(seq));
    check(history.newest().features != null, "the features of image 0 are still waited for");
    history.add(stream.image(FrameHistory.MAX_LAG + 1));
    Frame frame = history.newest();
    check(frame.image.seq == 1 && frame.features == null, "goes on without the silent process");
  }

  private static void restartOfTheSourceIsFollowed() throws Exception {
    SpyTestStream stream = new SpyTestStream(null);
    FrameHistory history = new FrameHistory();
    for (long seq = 0; seq < 20; ++seq) history.add(stream.image(seq));
    history.add(stream.image(0));
    check(history.newest().image.seq == 0, "same session, from the start again");
    image_t other = stream.image(3);
    other.session = SpyTestStream.SESSION + 1;
    history.add(other);
    history.add(stream.features(3));
    check(history.newest().image == other && history.newest().features == null,
        "features of another session are not drawn");
  }

  private static void badBytesAreCounted() {
    FrameHistory history = new FrameHistory();
    for (String channel : FrameHistory.CHANNELS) {
      history.messageReceived(null, channel, new LCMDataInputStream(new byte[] {1, 2, 3}));
    }
    check(history.numUndecodable() == 4, "four undecodable messages");
  }

  private static Object cell(StatusTableModel table, int row, String column) {
    return table.getValueAt(row, StatusTableModel.Column.valueOf(column).ordinal());
  }

  private static void statusTableNamesWhoIsStalledAndSilent() {
    StatusTableModel table = new StatusTableModel();
    table.add(SpyTestStream.status(8, "frontend"), 1000);
    table.add(SpyTestStream.status(9, "human_tracker"), 1000);
    check(table.getRowCount() == 2, "two processes");
    check(table.isHealthy(0) && cell(table, 0, "STATE").equals("READY"), "frontend is ready");
    check(!table.isHealthy(1) && cell(table, 1, "STATE").equals("STALLED"), "tracker is stalled");
    check(cell(table, 0, "TYPES").equals("01234567"), "which types it was built with");
    check(cell(table, 1, "WAITING_FOR").equals("PERSON_KEYPOINTS_RIGHT"), "and says for what");
    check(cell(table, 0, "REJECTED").equals(2L) && cell(table, 0, "P50").equals("21.5"), "figures");
    check(
        cell(table, 0, "WARNINGS").equals("the images are not rectified | times go back"),
        "what is doubtful, the newest first");
    table.refresh(1000 + StatusTableModel.SILENT_AFTER_MS + 1);
    check(!table.isHealthy(0) && cell(table, 0, "STATE").equals("SILENT"), "frontend fell silent");
  }
}
