package airdos.spy;

import airdos.human_observation_t;
import airdos.image_t;
import airdos.person_keypoints_t;
import airdos.static_features_t;
import java.awt.BasicStroke;
import java.awt.Color;
import java.awt.Font;
import java.awt.Graphics2D;
import java.awt.RenderingHints;
import java.awt.geom.Ellipse2D;
import java.awt.geom.Line2D;
import java.awt.geom.Rectangle2D;
import java.awt.image.BufferedImage;
import java.awt.image.DataBufferByte;
import java.io.ByteArrayInputStream;
import java.io.IOException;
import java.util.Locale;
import javax.imageio.ImageIO;

/** Draws one frame: the image with features, detections and tracks, and a line of text below. */
final class FrameRenderer {
  static final int TEXT_HEIGHT = 44;
  static final Color STEREO_FEATURE = new Color(0x00, 0xE0, 0x4D);
  static final Color MONO_FEATURE = new Color(0xFF, 0xD4, 0x00);
  static final Color UNTRACKED = new Color(0xF0, 0xF0, 0xF0);
  private static final Color BACKGROUND = new Color(0x20, 0x22, 0x26);
  private static final Color SHADOW = new Color(0, 0, 0, 170);
  private static final double GOLDEN_RATIO = 0.618033988749895;

  private image_t decodedFrom;
  private BufferedImage decoded;

  /** Gives neighbouring ids distinct colours; green and yellow are reserved for features. */
  static Color colourOf(long trackId) {
    double turn = (trackId * GOLDEN_RATIO) % 1.0;
    double hue = 0.50 + 0.59 * (turn < 0 ? turn + 1 : turn);  // cyan, blue, violet, red, orange
    return Color.getHSBColor((float) (hue % 1.0), 0.75f, 1.0f);
  }

  /** Fills width x height; the image keeps its aspect ratio. */
  void paint(Graphics2D g, Frame frame, int width, int height) {
    g.setColor(BACKGROUND);
    g.fillRect(0, 0, width, height);
    g.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON);
    g.setRenderingHint(RenderingHints.KEY_INTERPOLATION, RenderingHints.VALUE_INTERPOLATION_BILINEAR);
    if (frame == null) {
      paintLines(g, height - TEXT_HEIGHT, "No image on " + FrameHistory.IMAGE + " yet.",
          "If the spy lists it, set LCM_DEFAULT_URL to the spy's URL, or start launch_scripts/spy.sh.");
      return;
    }
    BufferedImage image = imageOf(frame.image);
    double scale = scaleOf(frame.image, width, height);
    if (image != null) {
      g.drawImage(image, 0, 0, (int) Math.round(frame.image.width * scale),
          (int) Math.round(frame.image.height * scale), null);
    }
    paintOverlay(g, frame, scale);
    paintLines(g, height - TEXT_HEIGHT, summary(frame), details(frame, image));
  }

  private static void paintOverlay(Graphics2D whole, Frame frame, double scale) {
    Graphics2D g = (Graphics2D) whole.create();
    g.clip(new Rectangle2D.Double(0, 0, frame.image.width * scale, frame.image.height * scale));
    if (frame.features != null) paintFeatures(g, frame.features, scale);
    if (frame.keypoints != null) paintDetections(g, frame.keypoints, scale);
    if (frame.humans != null) {
      for (human_observation_t human : frame.humans.humans) paintTrack(g, human, scale);
    }
    g.dispose();
  }

  static double scaleOf(image_t image, int width, int height) {
    return Math.min((double) width / Math.max(1, image.width),
        (double) (height - TEXT_HEIGHT) / Math.max(1, image.height));
  }

  /** Pixel centres have integer coordinates, so the image starts at -0.5. */
  static double toScreen(float pixel, double scale) {
    return (pixel + 0.5) * scale;
  }

  private static void paintFeatures(Graphics2D g, static_features_t features, double scale) {
    for (int i = 0; i < features.num_features; ++i) {
      double x = toScreen(features.u_left_px[i], scale);
      double y = toScreen(features.v_px[i], scale);
      fillDot(g, x, y, 3.8, SHADOW);
      fillDot(g, x, y, 2.8, features.has_right[i] ? STEREO_FEATURE : MONO_FEATURE);
    }
  }

  private static void paintDetections(Graphics2D g, person_keypoints_t message, double scale) {
    for (int person = 0; person < message.num_people; ++person) {
      paintSkeleton(g, Skeleton.jointsPx(message, person), scale, UNTRACKED, 1.2f);
    }
  }

  private static void paintTrack(Graphics2D g, human_observation_t human, double scale) {
    float[][] joints = Skeleton.jointsPx(human.joint_id, human.u_left_px, human.v_left_px);
    Color colour = colourOf(human.track_id);
    paintSkeleton(g, joints, scale, colour, 2.2f);
    float[] top = Skeleton.topOf(joints);
    if (top == null) return;
    String label = Long.toString(human.track_id);
    g.setFont(new Font(Font.SANS_SERIF, Font.BOLD, 13));
    int textWidth = g.getFontMetrics().stringWidth(label);
    int x = (int) (toScreen(top[0], scale) - textWidth / 2.0);
    int y = Math.max(13, (int) (toScreen(top[1], scale) - 7));
    g.setColor(SHADOW);
    g.fillRoundRect(x - 3, y - 12, textWidth + 6, 15, 6, 6);
    g.setColor(colour);
    g.drawString(label, x, y);
  }

  private static void paintSkeleton(
      Graphics2D g, float[][] joints, double scale, Color colour, float width) {
    g.setColor(colour);
    g.setStroke(new BasicStroke(width, BasicStroke.CAP_ROUND, BasicStroke.JOIN_ROUND));
    for (int[] segment : Skeleton.SEGMENTS) {
      float[] a = joints[segment[0]];
      float[] b = joints[segment[1]];
      if (a == null || b == null) continue;
      g.draw(new Line2D.Double(toScreen(a[0], scale), toScreen(a[1], scale),
          toScreen(b[0], scale), toScreen(b[1], scale)));
    }
    for (float[] joint : joints) {
      if (joint == null) continue;
      fillDot(g, toScreen(joint[0], scale), toScreen(joint[1], scale), width + 0.6, colour);
    }
  }

  private static void fillDot(Graphics2D g, double x, double y, double radius, Color colour) {
    g.setColor(colour);
    g.fill(new Ellipse2D.Double(x - radius, y - radius, 2 * radius, 2 * radius));
  }

  private static void paintLines(Graphics2D g, int top, String first, String second) {
    g.setFont(new Font(Font.SANS_SERIF, Font.PLAIN, 13));
    g.setColor(Color.WHITE);
    g.drawString(first, 8, top + 17);
    g.setColor(Color.LIGHT_GRAY);
    g.drawString(second, 8, top + 36);
  }

  static String summary(Frame frame) {
    String people = frame.keypoints == null ? "-" : Integer.toString(frame.keypoints.num_people);
    String tracked = frame.humans == null ? "-" : Integer.toString(frame.humans.num_humans);
    String features =
        frame.features == null ? "-" : Integer.toString(frame.features.num_features);
    String state = frame.features == null ? "-" : stateOf(frame.features.tracking_state);
    return String.format(Locale.ROOT,
        "seq %d   t %.3f s   camera %s   features %s   people detected %s, tracked %s",
        frame.image.seq, frame.image.utime / 1e6, state, features, people, tracked);
  }

  private static String details(Frame frame, BufferedImage image) {
    if (image == null) return "This image cannot be shown (encoding " + frame.image.encoding + ").";
    if (!frame.missingChannels().isEmpty()) {
      return "Not heard for this image: " + String.join(", ", frame.missingChannels());
    }
    return "green: static feature seen by both cameras   yellow: by the left one only   "
        + "white: person without a track";
  }

  static String stateOf(byte state) {
    switch (state) {
      case static_features_t.STATE_INITIALIZING:
        return "INITIALIZING";
      case static_features_t.STATE_TRACKING:
        return "TRACKING";
      case static_features_t.STATE_WEAK:
        return "WEAK";
      case static_features_t.STATE_COASTING:
        return "COASTING";
      default:
        return "INVALID";
    }
  }

  private BufferedImage imageOf(image_t message) {
    if (message != decodedFrom) {
      decoded = decode(message);
      decodedFrom = message;
    }
    return decoded;
  }

  /** Null if the bytes are not an image of the stated size. */
  static BufferedImage decode(image_t message) {
    switch (message.encoding) {
      case image_t.ENCODING_JPEG:
      case image_t.ENCODING_PNG:
        try {
          return ImageIO.read(new ByteArrayInputStream(message.data));
        } catch (IOException | RuntimeException e) {
          return null;
        }
      case image_t.ENCODING_RAW_GRAY8:
        return fromRows(message, 1, BufferedImage.TYPE_BYTE_GRAY);
      case image_t.ENCODING_RAW_BGR8:
        return fromRows(message, 3, BufferedImage.TYPE_3BYTE_BGR);
      default:
        return null;
    }
  }

  private static BufferedImage fromRows(image_t message, int numChannels, int type) {
    if (message.width <= 0 || message.height <= 0) return null;
    if ((long) message.width * message.height * numChannels != message.data.length) return null;
    BufferedImage image = new BufferedImage(message.width, message.height, type);
    byte[] pixels = ((DataBufferByte) image.getRaster().getDataBuffer()).getData();
    System.arraycopy(message.data, 0, pixels, 0, pixels.length);
    return image;
  }
}
