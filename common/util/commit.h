#ifndef AIRDOS_COMMON_UTIL_COMMIT_H_
#define AIRDOS_COMMON_UTIL_COMMIT_H_

namespace airdos {

/// Seven digits of the commit that was built; "unknown" where git could not tell. In a source file
/// that each build writes (cmake/write_commit.cmake).
extern const char kCommit[];

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_COMMIT_H_
