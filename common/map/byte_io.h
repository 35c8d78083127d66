#ifndef AIRDOS_COMMON_MAP_BYTE_IO_H_
#define AIRDOS_COMMON_MAP_BYTE_IO_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace airdos {

/// Serialises numbers as bytes, little-endian on every machine.
class ByteWriter {
 public:
  void U8(std::uint8_t value) { bytes_.push_back(value); }
  void U32(std::uint32_t value) { Integer(value, 4); }
  void I64(std::int64_t value) { Integer(static_cast<std::uint64_t>(value), 8); }
  void F32(float value);
  void F64(double value);
  void Text(const std::string& text);  ///< length (u32), followed by the bytes

  const std::vector<std::uint8_t>& bytes() const { return bytes_; }
  std::vector<std::uint8_t> Take() { return std::move(bytes_); }

 private:
  void Integer(std::uint64_t value, int num_bytes);
  std::vector<std::uint8_t> bytes_;
};

/// Reads them back. Past the end, every number is 0 and ok() is false.
class ByteReader {
 public:
  ByteReader(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  std::uint8_t U8() { return static_cast<std::uint8_t>(Integer(1)); }
  std::uint32_t U32() { return static_cast<std::uint32_t>(Integer(4)); }
  std::int64_t I64() { return static_cast<std::int64_t>(Integer(8)); }
  float F32();
  double F64();
  std::string Text();
  /// Reads the number of elements of at least `min_bytes` each. If the remaining bytes cannot hold
  /// that many, returns 0 and ok() becomes false.
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
