#include "processes/stereo_player/player_options.h"

#include "common/config/option_pages.h"
#include "common/util/error.h"
#include "common/util/words.h"
#include "processes/node/log/partial_source.h"

namespace airdos {

OptionTable TableOf(PlayerOptions* options) {
  OptionTable table(
      "stereo_player",
      "Defaults of airdos-stereo-player; a command-line option wins over the value here.");
  table.AddSection("lockstep");
  table.Add("lockstep.wait_for", &options->gate.wait_for,
            "processes that must have said READY and that must keep up, by their name in STATUS; "
            "separated by commas, empty: none");
  table.Add("lockstep.frames_in_flight", &options->gate.frames_in_flight, {1, 1000}, "frames",
            "at most this many on their way at once; 2 or more lets the processes overlap");
  table.AddSection("image");
  table.Add("image.max_image_bytes", &options->image.max_image_bytes, {1000, 100000000}, "bytes",
            "largest image file in a message; above about 128 kB receivers with the system's "
            "default buffers lose messages");
  table.Add("image.jpeg_qualities", &options->image.jpeg_qualities, {1, 100}, "1..100",
            "JPEG qualities, tried in this order until an image fits");
  return table;
}

PlayerArguments::PlayerArguments(CommandLine* app) : input_(app) {
  AddCommonOptions(PagesOf<PlayerOptions>(), app, &common_);
  app->Add("--first", &options_.first, "First frame").NotNegative();
  app->Add("--last", &options_.last, "Last frame, included").NotNegative();
  app->Add("--session", &options_.session,
           "Session number; default: the wall clock in us; a log keeps its own unless it is "
           "given or --loop is");
  app->Add("--loop", &options_.num_loops, "How often to play, each a session; 0: for ever")
      .ShowDefault()
      .NotNegative();
  app->AddFlag("--one-session", &options_.is_one_session,
               "With --loop: one long session, its times and image numbers go on");
  options_.recording.AddTo(app);
  AddInputCheckOptions(app, &options_.check);
  app->Add("--say-every", &options_.say_every, "Say how far it is every N frames").NotNegative();
  app->Add("--pace", &pace_, "lockstep: nothing is ever lost; realtime: like cameras")
      .ShowDefault()
      .OneOf({"lockstep", "realtime"});
  app->Add("--speed", &options_.speed, "realtime: speed relative to the recording")
      .ShowDefault()
      .Within(1e-3, 1e3);
  app->Add("--wait-for", &wait_for_,
           "Processes that must be READY and keep up, separated by commas; none: nobody");
  app->Add("--frames-in-flight", &frames_in_flight_, "lockstep: frames on their way at once")
      .Within(1, 1000);
  app->Add("--image-encoding", &encoding_,
           "auto: files that fit unchanged, else JPEG; png: lossless, whatever the size")
      .ShowDefault()
      .OneOf({"auto", "jpeg", "png"});
  app->Add("--without", &without_,
           "keypoints, masks or both, separated by commas: leave these channels to "
           "airdos-person-detector");
  app->AddFile("--write-log", &options_.write_log,
               "Write an LCM log of exactly these messages instead of publishing them");
}

PlayerOptions PlayerArguments::Resolve() const {
  using Encoding = ImagePackerOptions::Encoding;
  PlayerOptions options = options_;
  InputOptions input = input_;
  options.recording.Settle(&input);
  if (!options.recording.is_given()) options.data = input.path();
  options.check.calibration = options.recording.named_calibration();
  if (options.is_one_session && options.num_loops == 0)
    throw InputError("--one-session needs a --loop that ends");
  if (!options.write_log.empty() && options.num_loops != 1 && !options.is_one_session)
    throw InputError("--write-log writes what is played once: with --loop it needs --one-session");
  options.pace = pace_ == "lockstep" ? PlayerPace::kLockstep : PlayerPace::kRealtime;
  options.image.encoding = encoding_ == "auto"   ? Encoding::kAuto
                           : encoding_ == "jpeg" ? Encoding::kJpeg
                                                 : Encoding::kPng;
  ConfigReader config = ReadConfig(common_);
  TableOf(&options).Read(&config);
  FinishConfig(config, common_);
  options.without = SplitAtCommas(without_);
  ChannelsOfPeople("--without", options.without);  // or one of them is none
  if (wait_for_) options.gate.wait_for = SplitAtCommas(*wait_for_ == "none" ? "" : *wait_for_);
  if (frames_in_flight_) options.gate.frames_in_flight = *frames_in_flight_;
  return options;
}

}  // namespace airdos
