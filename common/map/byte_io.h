#ifndef AIRDOS_COMMON_MAP_BYTE_IO_H_
#define AIRDOS_COMMON_MAP_BYTE_IO_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace airdos {

/// Puts numbers into bytes, little endian whatever the machine.
class ByteWriter {
 public:
  void U8(std::uint8_t value) { bytes_.push_back(value); }
  void U32(std::uint32_t value) { Integer(value, 4); }
  void I64(std::int64_t value) { Integer(static_cast<std::uint64_t>(value), 8); }
  void F32(float value);
  void F64(double value);
  void Text(const std::string& text);  ///< length (u32), then the bytes

  const std::vector<std::uint8_t>& bytes() const { return bytes_; }
  std::vector<std::uint8_t> Take() { return std::move(bytes_); }

 private:
  void Integer(std::uint64_t value, int num_bytes);
  std::vector<std::uint8_t> bytes_;
};

/// Takes them out again. Beyond the end every number is 0 and ok() is false.
class ByteReader {
 public:
  ByteReader(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  std::uint8_t U8() { return static_cast<std::uint8_t>(Integer(1)); }
  std::uint32_t U32() { return static_cast<std::uint32_t>(Integer(4)); }
  std::int64_t I64() { return static_cast<std::int64_t>(Integer(8)); }
  float F32();
  double F64();
  std::string Text();
  /// A count of things of at least `min_bytes` each: 0 and not ok() where the bytes that are left
  /// cannot hold as many.
  std::uint32_t Count(std::size_t min_bytes);

  bool ok() const { return ok_; }
  std::size_t num_left() const { return size_ - position_; }

 private:
  std::uint64_t Integer(int num_bytes);
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t position_ = 0;
  bool ok_ = true;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_MAP_BYTE_IO_H_
