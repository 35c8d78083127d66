#include "common/map/byte_io.h"

#include <cstring>

namespace airdos {

void ByteWriter::F32(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  U32(bits);
}

void ByteWriter::F64(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  Integer(bits, 8);
}

void ByteWriter::Text(const std::string& text) {
  U32(static_cast<std::uint32_t>(text.size()));
  bytes_.insert(bytes_.end(), text.begin(), text.end());
}

void ByteWriter::Integer(std::uint64_t value, int num_bytes) {
  for (int i = 0; i < num_bytes; ++i) bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

float ByteReader::F32() {
  const std::uint32_t bits = U32();
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

double ByteReader::F64() {
  const std::uint64_t bits = Integer(8);
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

std::string ByteReader::Text() {
  const std::uint32_t size = Count(1);
  std::string text(reinterpret_cast<const char*>(data_ + position_), size);
  position_ += size;
  return text;
}

std::uint32_t ByteReader::Count(std::size_t min_bytes) {
  const std::uint32_t count = U32();
  if (count <= num_left() / min_bytes) return count;
  ok_ = false;
  return 0;
}

std::uint64_t ByteReader::Integer(int num_bytes) {
  if (num_left() < static_cast<std::size_t>(num_bytes)) {
    ok_ = false;
    position_ = size_;
    return 0;
  }
  std::uint64_t value = 0;
  for (int i = 0; i < num_bytes; ++i) {
    value |= static_cast<std::uint64_t>(data_[position_++]) << (8 * i);
  }
  return value;
}

}  // namespace airdos
