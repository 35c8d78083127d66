#ifndef AIRDOS_COMMON_DATASET_KEYPOINTS_KEYPOINT_COLLECTOR_H_
#define AIRDOS_COMMON_DATASET_KEYPOINTS_KEYPOINT_COLLECTOR_H_

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "common/dataset/keypoints/foreign_keypoints.h"

namespace airdos {

/// Gathers people by image while a file, or the files of a folder, are read.
class KeypointCollector {
 public:
  /// `possible`: the layouts that the program's files may have.
  KeypointCollector(const std::string& path, const std::string& program,
                    const std::vector<ForeignLayout>& possible);

  void SetProgram(const std::string& program) { result_.program = program; }
  /// An image, perhaps with nobody.
  void AddImage(const std::string& name);
  /// `where` stands before messages: "FILE: entry 3". `numbers`: u, v and confidence of each joint;
  /// none is nobody. Throws InputError for other counts than those of the layouts, or than those
  /// before.
  void AddPerson(const std::string& image, const std::string& where,
                 const std::vector<float>& numbers);
  /// Confidences as ReadForeignKeypoints() says. Throws InputError if no coordinate is in px.
  ForeignKeypoints Finish();

 private:
  ForeignImage* ImageOf(const std::string& name);
  void Keep(PersonKeypoints person, ForeignImage* image);
  void DecideBody25();
  void RefuseNormalized() const;
  void LimitConfidences();

  ForeignKeypoints result_;
  std::vector<ForeignLayout> possible_;
  std::map<std::string, std::size_t> place_of_;
  std::vector<std::vector<float>> undecided_;     // people in BODY_25 or BODY_25B
  std::vector<std::size_t> images_of_undecided_;  // their places in result_.images
  std::size_t num_empty_ = 0;                     // people without a joint that is seen
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_KEYPOINTS_KEYPOINT_COLLECTOR_H_
