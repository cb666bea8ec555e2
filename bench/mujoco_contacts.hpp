// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The contacts that MuJoCo finds between the near pairs of a tool.
#pragma once

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <support/families.hpp>
#include <vector>

namespace repel::bench {

/// A model whose tool has the solids A, at their poses in it, and whose world has the solids B.
/// Every pair is named, so that no time goes into finding the pairs.
class MuJoCoContacts {
 public:
  /// Contacts within `range` [m] are found; without `multiccd` one of a pair with a hull.
  MuJoCoContacts(std::span<const families::Pair> pairs, double range, bool multiccd)
      : model_(compile(pairs, range), mj_deleteModel),
        data_(mj_makeData(model_.get()), mj_deleteData),
        pairs_(pairs.size()) {
    if (!multiccd) model_->opt.disableflags |= mjDSBL_MULTICCD;
  }

  void place(const Pose& X_WT) {
    const Eigen::Quaterniond q(X_WT.linear());
    std::copy_n(X_WT.translation().data(), 3, data_->qpos);
    std::copy_n(std::array{q.w(), q.x(), q.y(), q.z()}.data(), 4, data_->qpos + 3);
    mj_kinematics(model_.get(), data_.get());
  }

  /// Returns the number of contacts.
  int find() {
    mj_collision(model_.get(), data_.get());
    return data_->ncon;
  }

  /// [m] The distance of the nearest contact of each pair; infinite without one.
  [[nodiscard]] std::vector<double> nearest() const {
    std::vector<double> all(pairs_, std::numeric_limits<double>::infinity());
    for (const mjContact& c : std::span(data_->contact, static_cast<std::size_t>(data_->ncon))) {
      // The geoms of the world come first, in the order of the pairs.
      double& least = all[static_cast<std::size_t>(std::min(c.geom[0], c.geom[1]))];
      least = std::min(least, c.dist);
    }
    return all;
  }

 private:
  static mjModel* compile(std::span<const families::Pair> pairs, double range) {
    const std::unique_ptr<mjSpec, void (*)(mjSpec*)> spec(mj_makeSpec(), mj_deleteSpec);
    spec->memory = 64 << 20;  // [B] for the contacts
    mjsBody* world = mjs_findBody(spec.get(), "world");
    mjsBody* tool = mjs_addBody(world, nullptr);
    mjs_addFreeJoint(tool);
    for (const families::Pair& pair : pairs) {
      const std::string name = std::to_string(&pair - pairs.data());
      add(*spec, tool, pair.A, pair.X_WA, "A" + name);
      add(*spec, world, pair.B, pair.X_WB, "B" + name);
      mjsPair* named = mjs_addPair(spec.get(), nullptr);
      mjs_setString(named->geomname1, ("A" + name).c_str());
      mjs_setString(named->geomname2, ("B" + name).c_str());
      named->margin = range;
    }
    mjModel* model = mj_compile(spec.get(), nullptr);
    if (model == nullptr) throw std::runtime_error(mjs_getError(spec.get()));
    return model;
  }

  static void add(mjSpec& spec, mjsBody* body, const families::Solid& s, const Pose& X,
                  const std::string& name) {
    mjsGeom* geom = mjs_addGeom(body, nullptr);
    mjs_setName(geom->element, name.c_str());
    const Eigen::Quaterniond q(X.linear());
    std::copy_n(X.translation().data(), 3, geom->pos);
    std::copy_n(std::array{q.w(), q.x(), q.y(), q.z()}.data(), 4, geom->quat);
    geom->contype = geom->conaffinity = 0;
    if (s.box) {
      geom->type = mjGEOM_BOX;
      std::copy_n(s.half_extents.data(), 3, geom->size);
      return;
    }
    mjsMesh* mesh = mjs_addMesh(&spec, nullptr);
    mjs_setName(mesh->element, name.c_str());
    std::vector<float> vertices;
    for (const Vec3& v : s.vertices) {
      for (int k = 0; k < 3; ++k) vertices.push_back(static_cast<float>(v[k]));
    }
    mjs_setFloat(mesh->uservert, vertices.data(), static_cast<int>(vertices.size()));
    geom->type = mjGEOM_MESH;
    mjs_setString(geom->meshname, name.c_str());
  }

  std::unique_ptr<mjModel, void (*)(mjModel*)> model_;
  std::unique_ptr<mjData, void (*)(mjData*)> data_;
  std::size_t pairs_;
};

}  // namespace repel::bench
