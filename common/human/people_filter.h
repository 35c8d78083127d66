#ifndef AIRDOS_COMMON_HUMAN_PEOPLE_FILTER_H_
#define AIRDOS_COMMON_HUMAN_PEOPLE_FILTER_H_

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "common/geometry/se3.h"
#include "common/human/skeleton.h"
#include "common/util/ids.h"

namespace airdos {

/// One person in one stereo frame, in the left camera C.
struct HumanMeasurement {
  /// A joint with its covariance.
  struct Joint {
    int joint = 0;  ///< COCO-18
    Eigen::Vector3d p_C = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance_C = Eigen::Matrix3d::Identity();  ///< m^2
  };
  HumanId id;
  std::vector<Joint> joints;
};

/// What a person contributes to the camera's pose: for each of n joints, its predicted position in
/// W and where the camera sees it. r = T_W_C p_C - p_W (3n values) has zero mean and this
/// covariance.
struct HumanConstraint {
  HumanId id;
  std::vector<Eigen::Vector3d> p_W;
  std::vector<Eigen::Vector3d> p_C;
  Eigen::MatrixXd covariance_W;  ///< 3n x 3n, m^2: prediction plus measurement
};

/// Settings of the PeopleFilter.
struct PeopleFilterOptions {
  double acceleration_m_s2 = 3;          ///< per axis, initial value for each person
  double min_acceleration_factor = 0.3;  ///< lower limit for a very steady person
  double max_acceleration_factor = 5;
  double initial_speed_m_s = 1;  ///< per axis
  double wobble_m = 0.03;        ///< of each joint relative to the body in 0.1 s
  double max_joint_sigmas = 4;   ///< a joint that is farther off is left out
  int max_missed_frames = 5;     ///< then the person is forgotten
  int min_seen_frames = 1;       ///< before a person constrains the camera
};

/// Predicts where people will be. Each person is a constant-velocity filter in W: the body joints,
/// each with its own wobble, share one velocity that changes at random,
///
///   q_j' = q_j + dt v' + wobble_j,   v' = v + dt a,   a ~ N(0, sigma_a^2)
///
/// (paper, eq. 4: one motion for all points of a rigid part; here a translation). How strongly a
/// person accelerates is learnt from the errors of the predictions. Deterministic; ordered by id.
class PeopleFilter {
 public:
  explicit PeopleFilter(const PeopleFilterOptions& options) : options_(options) {}

  /// Predicts everyone forward in time.
  void Predict(double step_s);
  /// Constraints that the people of this frame put on the camera, which is near T_W_C. Uses people
  /// who have been known long enough, and those of their joints that are plausible given
  /// `pose_covariance` (tangent of T_W_C).
  std::vector<HumanConstraint> Constrain(const std::vector<HumanMeasurement>& people,
                                         const Se3& T_W_C, const Matrix6d& pose_covariance) const;
  /// Takes in the people of this frame, seen from T_W_C with the given covariance.
  void Update(const std::vector<HumanMeasurement>& people, const Se3& T_W_C,
              const Matrix6d& pose_covariance);
  /// Moves everyone along when W has been corrected.
  void Transform(const Se3& T_Wnew_Wold);

  std::size_t num_people() const { return people_.size(); }

 private:
  static constexpr int kStateSize = 3 + 3 * kNumBodyJoints;
  using State = Eigen::Matrix<double, kStateSize, 1>;
  using Covariance = Eigen::Matrix<double, kStateSize, kStateSize>;
  /// The filter's state of one person.
  struct Person {
    State state = State::Zero();  // velocity, then the joints of kBodyJoints
    Covariance covariance = Covariance::Zero();
    std::array<bool, kNumBodyJoints> is_known = {};
    double acceleration_m_s2 = 0;
    int num_seen = 0;
    int num_missed = 0;
  };
  /// A measurement of known joints, compared with the prediction.
  struct Match {
    std::vector<int> places;  // indices into kBodyJoints
    std::vector<Eigen::Vector3d> p_C;
    Eigen::VectorXd residual_W;
    Eigen::MatrixXd predicted_W;  // covariance of the prediction
    Eigen::MatrixXd measured_W;   // of the measurement, given the camera's pose
    Eigen::MatrixXd jacobian;     // of the residual with respect to the tangent of T_W_C
  };

  std::optional<Match> MatchJoints(const Person& person, const HumanMeasurement& measurement,
                                   const Se3& T_W_C, const Matrix6d& pose_covariance) const;
  Person Begin() const;
  void Correct(const Match& match, const Matrix6d& pose_covariance, Person* person) const;
  void LearnAcceleration(const Match& match, const Matrix6d& pose_covariance, Person* person) const;
  void AddNewJoints(const HumanMeasurement& measurement, const Se3& T_W_C,
                    const Matrix6d& pose_covariance, Person* person) const;

  PeopleFilterOptions options_;
  std::map<HumanId, Person> people_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_PEOPLE_FILTER_H_
