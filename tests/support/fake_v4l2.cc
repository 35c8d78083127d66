// A stereo camera of Video4Linux for programs that are started with this library in LD_PRELOAD:
// what they open at the path in AIRDOS_FAKE_V4L2 delivers 128 x 48 pixels in YUYV, 50 images a
// second, the left half dark and the right one bright, each captured 0.3 s before. It is unplugged
// while there is no such file. Only what OpenCV asks of a device is answered.
#include <dlfcn.h>
#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdarg>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <thread>

namespace {

constexpr std::uint32_t kWidth = 128;
constexpr std::uint32_t kHeight = 48;
constexpr std::uint32_t kRate_hz = 50;
constexpr std::size_t kBytes = 2 * kWidth * kHeight;
constexpr std::size_t kPage = 4096;
constexpr std::uint32_t kMostBuffers = 8;
constexpr std::int64_t kAge_us = 300000;
constexpr std::uint8_t kDark = 60;
constexpr std::uint8_t kBright = 180;

std::array<void*, kMostBuffers> buffers;
std::uint32_t next_buffer = 0;
std::uint32_t num_buffers = 0;
std::atomic<int> device{-1};  // an event counter: readable when an image is there
std::atomic<bool> is_streaming{false};

const char* Path() {
  const char* path = std::getenv("AIRDOS_FAKE_V4L2");
  return path == nullptr ? "" : path;
}

bool IsPluggedIn() { return access(Path(), F_OK) == 0; }

template <class Function>
Function Original(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

void Deliver() {
  while (true) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1000 / kRate_hz));
    const std::uint64_t one = 1;
    if (is_streaming && IsPluggedIn()) {
      [[maybe_unused]] const ssize_t written = write(device, &one, sizeof(one));
    }
  }
}

int Open() {
  static const bool is_delivering = [] {
    std::thread(Deliver).detach();
    return true;
  }();
  static_cast<void>(is_delivering);
  is_streaming = false;
  const int opened = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC | EFD_SEMAPHORE);
  device = opened;
  return opened;
}

void Fill(v4l2_format* format) {
  format->fmt.pix.width = kWidth;
  format->fmt.pix.height = kHeight;
  format->fmt.pix.pixelformat = V4L2_PIX_FMT_YUYV;
  format->fmt.pix.bytesperline = 2 * kWidth;
  format->fmt.pix.sizeimage = kBytes;
}

void FillImage(std::uint8_t* pixels) {
  for (std::size_t i = 0; i < kWidth * kHeight; ++i) {
    pixels[2 * i] = i % kWidth < kWidth / 2 ? kDark : kBright;
    pixels[2 * i + 1] = 128;  // no colour
  }
}

int Dequeue(v4l2_buffer* buffer) {
  if (!IsPluggedIn()) {
    errno = ENODEV;
    return -1;
  }
  std::uint64_t one = 0;
  if (read(device, &one, sizeof(one)) < 0) return -1;  // EAGAIN
  buffer->index = next_buffer;
  next_buffer = (next_buffer + 1) % num_buffers;
  buffer->bytesused = kBytes;
  buffer->length = kBytes;
  timespec now = {};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const std::int64_t stamp_us = 1000000 * now.tv_sec + now.tv_nsec / 1000 - kAge_us;
  buffer->timestamp = {stamp_us / 1000000, stamp_us % 1000000};
  FillImage(static_cast<std::uint8_t*>(buffers[buffer->index]));
  return 0;
}

int Answer(unsigned long request, void* argument) {
  switch (request) {
    case VIDIOC_QUERYCAP:
      static_cast<v4l2_capability*>(argument)->capabilities =
          V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
      return 0;
    case VIDIOC_G_INPUT:
      *static_cast<int*>(argument) = 0;
      return 0;
    case VIDIOC_ENUMINPUT:
    case VIDIOC_S_INPUT:
    case VIDIOC_QBUF:
      return 0;
    case VIDIOC_G_FMT:
    case VIDIOC_S_FMT:
      Fill(static_cast<v4l2_format*>(argument));
      return 0;
    case VIDIOC_G_PARM:
    case VIDIOC_S_PARM:
      static_cast<v4l2_streamparm*>(argument)->parm.capture.capability = V4L2_CAP_TIMEPERFRAME;
      static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe = {1, kRate_hz};
      return 0;
    case VIDIOC_REQBUFS: {
      auto* wanted = static_cast<v4l2_requestbuffers*>(argument);
      if (wanted->count > kMostBuffers) wanted->count = kMostBuffers;
      num_buffers = wanted->count;
      next_buffer = 0;
      return 0;
    }
    case VIDIOC_QUERYBUF: {
      auto* buffer = static_cast<v4l2_buffer*>(argument);
      buffer->length = kBytes;
      buffer->m.offset = static_cast<std::uint32_t>(buffer->index * 4 * kPage);
      return 0;
    }
    case VIDIOC_STREAMON:
    case VIDIOC_STREAMOFF:
      is_streaming = request == VIDIOC_STREAMON;
      return 0;
    case VIDIOC_DQBUF:
      return Dequeue(static_cast<v4l2_buffer*>(argument));
    default:
      errno = EINVAL;
      return -1;
  }
}

int OpenAny(const char* name, const char* path, int flags, mode_t mode) {
  if (std::strcmp(path, Path()) == 0 && IsPluggedIn()) return Open();
  return Original<int (*)(const char*, int, ...)>(name)(path, flags, mode);
}

void* MapAny(const char* name, void* where, std::size_t size, int protection, int flags, int file,
             off_t offset) {
  const auto map = Original<void* (*)(void*, std::size_t, int, int, int, off_t)>(name);
  if (file < 0 || file != device) return map(where, size, protection, flags, file, offset);
  void* memory = map(where, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  buffers[static_cast<std::size_t>(offset) / (4 * kPage)] = memory;
  return memory;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return OpenAny("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return OpenAny("open64", path, flags, mode);
}

int ioctl(int file, unsigned long request, ...) noexcept {
  va_list rest;
  va_start(rest, request);
  void* argument = va_arg(rest, void*);
  va_end(rest);
  if (file >= 0 && file == device) return Answer(request, argument);
  return Original<int (*)(int, unsigned long, ...)>("ioctl")(file, request, argument);
}

void* mmap(void* where, std::size_t size, int protection, int flags, int file,
           off_t offset) noexcept {
  return MapAny("mmap", where, size, protection, flags, file, offset);
}

void* mmap64(void* where, std::size_t size, int protection, int flags, int file,
             off64_t offset) noexcept {
  return MapAny("mmap64", where, size, protection, flags, file, offset);
}

}  // extern "C"
