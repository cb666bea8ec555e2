#include <repel/world/arm.hpp>

#include <gtest/gtest.h>

namespace repel {
namespace arm_test {

struct Arm {
  void set_torques(std::span<const double>) noexcept {}
  void step(double) noexcept {}
  void read_positions(std::span<double>) const noexcept {}
  void read_velocities(std::span<double>) const noexcept {}
};

struct ArmWithBrakes : Arm {
  void enable() noexcept {}
  void stop() noexcept {}
  void engage_brakes(bool) noexcept {}
  [[nodiscard]] ArmState state() const noexcept { return ArmState::enabled; }
};

struct ArmWhoseStopMayThrow : ArmWithBrakes {
  void stop() {}
};

struct Kinematics {
  void update(std::span<const double>) noexcept {}
  [[nodiscard]] Pose X_WT() const noexcept { return Pose::Identity(); }
  void tool_jacobian(Eigen::Ref<Eigen::Matrix<double, 6, Eigen::Dynamic>>) const noexcept {}
  [[nodiscard]] Pose X_WL(int) const noexcept { return Pose::Identity(); }
  void jacobian(int, const Vec3&,
                Eigen::Ref<Eigen::Matrix<double, 6, Eigen::Dynamic>>) const noexcept {}
  void gravity_torques(std::span<double>) noexcept {}
};

struct ArmThatCannotStep {
  void set_torques(std::span<const double>) noexcept {}
  void read_positions(std::span<double>) const noexcept {}
  void read_velocities(std::span<double>) const noexcept {}
};

struct ArmThatReportsFailure : Arm {
  bool set_torques(std::span<const double>) noexcept { return false; }
};

struct ArmThatChangesWhenRead : ArmThatCannotStep {
  void step(double) noexcept {}
  void read_positions(std::span<double>) noexcept {}
};

struct KinematicsWithoutGravity {
  void update(std::span<const double>) noexcept {}
  [[nodiscard]] Pose X_WT() const noexcept { return Pose::Identity(); }
  void tool_jacobian(Eigen::Ref<Eigen::Matrix<double, 6, Eigen::Dynamic>>) const noexcept {}
  [[nodiscard]] Pose X_WL(int) const noexcept { return Pose::Identity(); }
  void jacobian(int, const Vec3&,
                Eigen::Ref<Eigen::Matrix<double, 6, Eigen::Dynamic>>) const noexcept {}
};

struct KinematicsOfTheToolAlone {
  void update(std::span<const double>) noexcept {}
  [[nodiscard]] Pose X_WT() const noexcept { return Pose::Identity(); }
  void tool_jacobian(Eigen::Ref<Eigen::Matrix<double, 6, Eigen::Dynamic>>) const noexcept {}
  void gravity_torques(std::span<double>) noexcept {}
};

static_assert(TorqueDrivenArm<Arm>);
static_assert(!TorqueDrivenArm<ArmThatCannotStep>);
static_assert(!TorqueDrivenArm<ArmThatReportsFailure>);
static_assert(!TorqueDrivenArm<ArmThatChangesWhenRead>);
static_assert(!BrakedArm<Arm>, "an arm without brakes is a torque-driven arm all the same");
static_assert(BrakedArm<ArmWithBrakes>);
static_assert(!BrakedArm<ArmWhoseStopMayThrow>);
static_assert(ArmKinematics<Kinematics>);
static_assert(!ArmKinematics<KinematicsWithoutGravity>);
static_assert(!ArmKinematics<KinematicsOfTheToolAlone>);
static_assert(!ArmKinematics<Arm>);

TEST(ArmModel, IsEmptyAndAtTheOriginUnlessSaidOtherwise) {
  const ArmModel model;
  EXPECT_TRUE(model.links.empty());
  EXPECT_TRUE(model.X_WB.isApprox(Pose::Identity()));
  EXPECT_TRUE(model.X_LT.isApprox(Pose::Identity()));
  EXPECT_EQ(model.gravity_W, Vec3(0, 0, -9.81));
}

}  // namespace arm_test
}  // namespace repel
