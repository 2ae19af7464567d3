// Grbl's settings over a machine file.
#include "trammel/grbl/settings.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "router.hpp"

namespace trammel::grbl {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class SettingsFile : public testing::Test {
 protected:
  SettingsFile() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / fmt::format("trammel_grbl_{}_{}", test->name(), ::getpid());
    std::filesystem::create_directories(folder_);
    file_ = (folder_ / "settings").string();
  }
  ~SettingsFile() override { std::filesystem::remove_all(folder_); }

  std::string text() const {
    std::ifstream in(file_);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
  }
  void write(const std::string& text) const { std::ofstream(file_) << text; }
  std::string refusal() const {
    try {
      const Settings settings(router(), file_);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "taken";
  }

  std::filesystem::path folder_;
  std::string file_;
};

TEST(Settings, HasGrblsLinesInGrblsOrder) {
  const Settings settings(router(), "");
  EXPECT_THAT(settings.lines(),
              ElementsAre("$0=10", "$1=25", "$2=0", "$3=0", "$4=0", "$5=0", "$6=0", "$10=1", "$11=0.010", "$12=0.002",
                          "$13=0", "$20=0", "$21=0", "$22=0", "$23=0", "$24=25.000", "$25=500.000", "$26=250",
                          "$27=1.000", "$30=1000", "$31=0", "$32=0", "$100=250.000", "$101=250.000", "$102=250.000",
                          "$110=3000.000", "$111=3000.000", "$112=3000.000", "$120=500.000", "$121=500.000",
                          "$122=500.000", "$130=0.000", "$131=0.000", "$132=0.000"));
}

TEST(Settings, TellsWhatTheMachineFileSays) {
  machine::Machine machine = fenced_router();
  machine.axes[1].inverted = true;
  machine.axes[2].inverted = true;
  machine.axes[0].steps_per_mm = 320.5;
  machine.axes[2].max_velocity = 8;
  machine.axes[1].min = -150;
  machine.outputs.max_s = 24'000;
  machine.outputs.laser = true;
  machine.motion.junction_deviation = 0.02;
  machine.require_home = true;
  const Settings settings(machine, "");
  EXPECT_EQ(settings.value(3), 6);
  EXPECT_EQ(settings.value(11), 0.02);
  EXPECT_EQ(settings.value(20), 1);
  EXPECT_EQ(settings.value(22), 1);
  EXPECT_EQ(settings.value(30), 24'000);
  EXPECT_EQ(settings.value(32), 1);
  EXPECT_EQ(settings.value(100), 320.5);
  EXPECT_EQ(settings.value(112), 480);
  EXPECT_EQ(settings.value(130), 200);
  EXPECT_EQ(settings.value(131), 150);
}

TEST(Settings, RefusesWithGrblsNumbers) {
  Settings settings(router(), "");
  EXPECT_EQ(settings.set(0, 2), Status::kStepPulseTooShort);
  EXPECT_EQ(settings.set(0, -1), Status::kNegativeValue);
  EXPECT_EQ(settings.set(7, -1), Status::kNegativeValue);
  EXPECT_EQ(settings.set(110, -500), Status::kNegativeValue);
  EXPECT_EQ(settings.set(20, 1), Status::kSoftLimitsNeedHoming);
  EXPECT_EQ(settings.set(20, 0), Status::kOk);
  for (const int number : {7, 8, 9, 14, 19, 28, 29, 33, 99, 103, 109, 113, 119, 123, 129, 133, 140, 255, 256, 1000}) {
    EXPECT_EQ(settings.set(number, 1), Status::kInvalidStatement) << number;
  }
  const std::vector<std::string> before = settings.lines();
  EXPECT_NE(settings.set(100, std::numeric_limits<double>::infinity()), Status::kOk);
  EXPECT_NE(settings.set(100, std::nan("")), Status::kOk);
  EXPECT_NE(settings.set(120, 0), Status::kOk);  // an acceleration of 0 never moves
  EXPECT_EQ(settings.lines(), before);
}

TEST(Settings, ChangesTheMachine) {
  Settings settings(fenced_router(), "");
  for (const auto& [number, value] : std::map<int, double>{{0, 5},
                                                           {3, 5},
                                                           {11, 0.05},
                                                           {30, 12'000},
                                                           {32, 1},
                                                           {100, 80},
                                                           {101, 81},
                                                           {102, 400},
                                                           {110, 6000},
                                                           {112, 600},
                                                           {121, 20},
                                                           {130, 300}}) {
    EXPECT_EQ(settings.set(number, value), Status::kOk) << number;
    EXPECT_EQ(settings.value(number), value) << number;
    EXPECT_TRUE(Settings::changes_machine(number)) << number;
  }
  const machine::Machine& machine = settings.machine();
  EXPECT_EQ(machine.axes[0].step_length_ns, 5000);
  EXPECT_EQ(machine.axes[2].step_length_ns, 5000);
  EXPECT_TRUE(machine.axes[0].inverted);
  EXPECT_FALSE(machine.axes[1].inverted);
  EXPECT_TRUE(machine.axes[2].inverted);
  EXPECT_EQ(machine.motion.junction_deviation, 0.05);
  EXPECT_EQ(machine.outputs.max_s, 12'000);
  EXPECT_TRUE(machine.outputs.laser);
  EXPECT_EQ(machine.axes[1].steps_per_mm, 81);
  EXPECT_EQ(machine.axes[0].max_velocity, 100);
  EXPECT_EQ(machine.axes[2].max_velocity, 10);
  EXPECT_EQ(machine.axes[1].max_acceleration, 20);
  EXPECT_EQ(machine.axes[1].max_velocity, 50);  // unchanged, as in the machine file
  EXPECT_EQ(machine.axes[0].max - machine.axes[0].min, 300);
}

TEST(Settings, LeavesTheMachineWhereTheyTellNothingOfIt) {
  for (const int number : {1, 2, 4, 5, 6, 10, 12, 13, 21, 23, 24, 25, 26, 27, 31}) {
    EXPECT_FALSE(Settings::changes_machine(number)) << number;
  }
}

TEST(Settings, KeepsTheEndOfTravelThatTheMachineFileHas) {
  machine::Machine machine = fenced_router();  // -200 to 0
  machine.axes[1].min = 0;
  machine.axes[1].max = 200;
  machine.axes[2].min = 5;
  machine.axes[2].max = std::numeric_limits<double>::infinity();
  Settings settings(machine, "");
  for (const int number : {130, 131, 132}) EXPECT_EQ(settings.set(number, 50), Status::kOk);
  EXPECT_EQ(settings.machine().axes[0].min, -50);
  EXPECT_EQ(settings.machine().axes[0].max, 0);
  EXPECT_EQ(settings.machine().axes[1].max - settings.machine().axes[1].min, 50);
  EXPECT_EQ(settings.machine().axes[2].min, 5);
  EXPECT_EQ(settings.machine().axes[2].max, 55);
}

TEST(Settings, HasSoftLimitsOnlyWithHoming) {
  Settings settings(fenced_router(), "");
  EXPECT_EQ(settings.set(22, 1), Status::kOk);
  EXPECT_EQ(settings.set(20, 0), Status::kOk);
  EXPECT_TRUE(std::isinf(settings.machine().axes[0].min));
  EXPECT_EQ(settings.set(20, 1), Status::kOk);
  EXPECT_EQ(settings.machine().axes[0].min, -200);
  EXPECT_EQ(settings.set(22, 0), Status::kOk);
  EXPECT_EQ(settings.value(20), 0);
  EXPECT_TRUE(std::isinf(settings.machine().axes[0].max));
  EXPECT_EQ(settings.set(20, 1), Status::kSoftLimitsNeedHoming);
}

// A sender sets a travel on a machine without limits. As in Grbl the range is -travel to 0, and only with $20.
TEST(Settings, GivesAMachineWithoutLimitsThoseOfItsTravel) {
  Settings settings(router(), "");
  EXPECT_EQ(settings.set(130, 100), Status::kOk);
  EXPECT_TRUE(std::isinf(settings.machine().axes[0].min)) << "$20=0";
  EXPECT_EQ(settings.set(22, 1), Status::kOk);
  EXPECT_EQ(settings.set(20, 1), Status::kOk);
  EXPECT_EQ(settings.machine().axes[0].min, -100);
  EXPECT_EQ(settings.machine().axes[0].max, 0);
}

TEST(Settings, CutsSwitchesToWholeNumbers) {
  Settings settings(router(), "");
  EXPECT_EQ(settings.set(10, 3.9), Status::kOk);
  EXPECT_EQ(settings.value(10), 3);
  EXPECT_EQ(settings.set(13, 0.9), Status::kOk);
  EXPECT_FALSE(settings.flag(13));
}

TEST(Settings, HasNoAxesThatTheMachineLacks) {
  machine::Machine machine = router();
  machine.axes.pop_back();
  Settings settings(machine, "");
  EXPECT_EQ(settings.set(102, 100), Status::kOk);
  EXPECT_EQ(settings.machine().axes.size(), 2U);
}

TEST_F(SettingsFile, KeepsWhatWasChanged) {
  {
    Settings settings(router(), file_);
    EXPECT_EQ(settings.set(110, 1234.5678), Status::kOk);
    EXPECT_EQ(settings.set(10, 3), Status::kOk);
    settings.set_startup(1, "G55G20");
    settings.set_build_text("MY ROUTER=1");
    settings.set_parameters({{5221, 1.0 / 3}, {5161, -7}, {5211, 5}, {5210, 1}, {5220, 2}});
  }
  const Settings again(router(), file_);
  EXPECT_EQ(again.value(110), 1234.5678);
  EXPECT_EQ(again.machine().axes[0].max_velocity, 1234.5678 / 60);
  EXPECT_EQ(again.value(10), 3);
  EXPECT_EQ(again.value(111), 3000);
  EXPECT_EQ(again.startup(0), "");
  EXPECT_EQ(again.startup(1), "G55G20");
  EXPECT_EQ(again.build_text(), "MY ROUTER=1");
  // As in Grbl, G92 and the active coordinate system are not kept.
  EXPECT_EQ(again.parameters(), (std::map<int, double>{{5221, 1.0 / 3}, {5161, -7}}));
}

TEST_F(SettingsFile, FollowsTheMachineFileInWhatWasNotChanged) {
  Settings(router(), file_).set(110, 1000);
  machine::Machine other = router();
  other.axes[0].max_velocity = 99;
  other.axes[1].max_velocity = 99;
  const Settings settings(other, file_);
  EXPECT_EQ(settings.value(110), 1000);
  EXPECT_EQ(settings.value(111), 99 * 60);
}

TEST_F(SettingsFile, IsNotNeeded) {
  EXPECT_EQ(refusal(), "taken");
  EXPECT_FALSE(std::filesystem::exists(file_)) << "nothing was changed";
}

TEST_F(SettingsFile, IsRefusedWhereItIsDamaged) {
  for (const char* const line : {"$110", "=5", "nonsense", "$110=", "$110=fast", "$7=1", "$=3", "110=500", "$1x0=500",
                                 "$110=500x", "$110=-5", "$100=0", "$110=nan", "#abc=1", "#5221=1e999x", "$N7=G0"}) {
    write(std::string("$10=3\n") + line + "\n");
    EXPECT_THAT(refusal(), AllOf(HasSubstr(file_), HasSubstr(line))) << line;
  }
  write("$10=3\n\n$13=1\n");
  EXPECT_NE(refusal(), "taken");
}

TEST_F(SettingsFile, IsRefusedWhereItCannotBeRead) {
  std::filesystem::create_directories(file_);
  EXPECT_THAT(refusal(), HasSubstr(file_));
}

TEST_F(SettingsFile, StaysWholeWhereItCannotBeWritten) {
  Settings settings(router(), file_);
  EXPECT_EQ(settings.set(110, 1000), Status::kOk);
  const std::string before = text();
  std::filesystem::create_directories(file_ + ".new");  // prevents the new file
  EXPECT_EQ(settings.take_trouble(), "");
  EXPECT_EQ(settings.set(110, 2000), Status::kOk);
  EXPECT_EQ(settings.value(110), 2000) << "in force";
  EXPECT_THAT(settings.take_trouble(), HasSubstr(file_));
  EXPECT_EQ(settings.take_trouble(), "") << "told once";
  EXPECT_EQ(text(), before);
}

TEST_F(SettingsFile, ForgetsWhatIsRestored) {
  Settings settings(router(), file_);
  EXPECT_EQ(settings.set(110, 1000), Status::kOk);
  settings.set_startup(0, "G21");
  settings.restore();
  EXPECT_EQ(settings.value(110), 3000);
  EXPECT_EQ(settings.machine().axes[0].max_velocity, 50);
  EXPECT_EQ(settings.startup(0), "G21");
  const Settings again(router(), file_);
  EXPECT_EQ(again.value(110), 3000);
  EXPECT_EQ(again.startup(0), "G21");
}

}  // namespace
}  // namespace trammel::grbl
