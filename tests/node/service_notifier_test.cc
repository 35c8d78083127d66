#include "processes/node/live/service_notifier.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/notify_socket.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

class ServiceNotifierTest : public testing::Test {
 protected:
  ScratchFolder folder_{"service_notifier"};
  std::string path_ = folder_.PathOf("notify");
  std::ostringstream said_;
  ProcessLog log_{"p", LogLevel::kInfo, LogStyle::kJournal, &said_, nullptr};
};

TEST_F(ServiceNotifierTest, ReadyIsSaidOnce) {
  const NotifySocket manager(path_);
  ServiceNotifier service(path_, &log_);
  service.Tell("two\nlines");
  service.Tell("later");
  service.TellStopping("over");
  EXPECT_EQ(manager.NextNow(), "READY=1\nSTATUS=two lines\nWATCHDOG=1");
  EXPECT_EQ(manager.NextNow(), "STATUS=later\nWATCHDOG=1");
  EXPECT_EQ(manager.NextNow(), "STOPPING=1\nSTATUS=over");
  EXPECT_EQ(manager.NextNow(), "");
  EXPECT_EQ(said_.str(), "");
}

TEST_F(ServiceNotifierTest, TheFirstIsDueAtOnceAndTheNextAfterASecond) {
  const NotifySocket manager(path_);
  ServiceNotifier service(path_, &log_);
  service.TellWhenDue(-5, "1");
  service.TellWhenDue(-4.01, "2");
  service.TellWhenDue(-4, "3");
  EXPECT_EQ(manager.NextNow(), "READY=1\nSTATUS=1\nWATCHDOG=1");
  EXPECT_EQ(manager.NextNow(), "STATUS=3\nWATCHDOG=1");
  EXPECT_EQ(manager.NextNow(), "");
}

TEST_F(ServiceNotifierTest, ASocketWithoutAFileIsFound) {
  const std::string name = "@airdos_service_notifier_" + std::to_string(getpid());
  const NotifySocket manager(name);
  ServiceNotifier service(name, &log_);
  service.Tell("here");
  EXPECT_EQ(manager.NextNow(), "READY=1\nSTATUS=here\nWATCHDOG=1");
}

TEST_F(ServiceNotifierTest, NobodyIsToldWhereNobodyAsked) {
  ServiceNotifier service("", &log_);
  service.Tell("x");
  service.TellStopping("x");
  EXPECT_EQ(said_.str(), "");
}

TEST_F(ServiceNotifierTest, AManagerThatIsNotThereIsSaidOnce) {
  for (const std::string& socket :
       std::vector<std::string>{path_, "relative", "vsock:2:1", "/" + std::string(200, 'x')}) {
    said_.str("");
    ServiceNotifier service(socket, &log_);
    service.Tell("x");
    service.TellStopping("x");
    EXPECT_EQ(said_.str().find("<4>the service manager cannot be told"), 0u) << said_.str();
    EXPECT_NE(said_.str().find("'" + socket + "'"), std::string::npos) << said_.str();
    EXPECT_EQ(said_.str().find('\n'), said_.str().size() - 1) << said_.str();
  }
}

TEST_F(ServiceNotifierTest, AManagerThatWentAwayIsSaidOnce) {
  auto manager = std::make_unique<NotifySocket>(path_);
  ServiceNotifier service(path_, &log_);
  service.Tell("x");
  manager.reset();
  service.Tell("y");
  service.Tell("z");
  EXPECT_NE(said_.str().find("Connection refused"), std::string::npos) << said_.str();
  EXPECT_EQ(said_.str().find('\n'), said_.str().size() - 1) << said_.str();
}

}  // namespace
}  // namespace airdos
