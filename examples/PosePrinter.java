import airdos.state_estimate_t;
import java.io.IOException;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMSubscriber;

/**
 * Prints where the camera is, for each image.
 *
 * <p>Java's decode() is as lcm-gen makes it, without bounds: for a network on which nobody else may send.
 */
public class PosePrinter implements LCMSubscriber {
  @Override
  public void messageReceived(LCM lcm, String channel, LCMDataInputStream bytes) {
    try {
      state_estimate_t pose = new state_estimate_t(bytes);
      if (pose.status == state_estimate_t.STATUS_INVALID) return;
      double[] camera = pose.position_W_C;
      System.out.printf("image %d: camera at %.3f %.3f %.3f%n", pose.seq, camera[0], camera[1], camera[2]);
    } catch (IOException e) {
      System.err.println("not a pose: " + e);
    }
  }

  public static void main(String[] args) throws IOException, InterruptedException {
    new LCM().subscribe("STATE_ESTIMATE", new PosePrinter());
    System.out.println("listening");
    Thread.currentThread().join();
  }
}
