// SPDX-License-Identifier: BSD-3-Clause
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rival.hpp"

namespace repel::bench {

namespace {

class MuJoCo {
 public:
  struct Result {
    double distance;
    double p_WA_p_WB[6];
  };

  MuJoCo(const Task& task, double tolerance) : task_(task), model_(compile(task), mj_deleteModel) {
    model_->opt.ccd_tolerance = tolerance;
    model_->opt.ccd_iterations = 1000;
    keep_vertices_where_they_were();
    data_ = {mj_makeData(model_.get()), mj_deleteData};
    for (const std::vector<Pose>& X_W : task.X_W) {
      auto& placed = X_W_.emplace_back();
      for (const Pose& X : X_W) {
        const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> R = X.linear();
        placed.positions.insert(placed.positions.end(), X.translation().data(),
                                X.translation().data() + 3);
        placed.rotations.insert(placed.rotations.end(), R.data(), R.data() + 9);
      }
    }
  }

  Result cold(const Ask& ask) {
    const auto& [a, b] = task_.pairs[ask.pair];
    // All geoms of a tick are placed by setting two pointers: the timed section copies no pose.
    data_->geom_xpos = X_W_[ask.tick].positions.data();
    data_->geom_xmat = X_W_[ask.tick].rotations.data();
    Result r;
    r.distance = mj_geomDistance(model_.get(), data_.get(), static_cast<int>(a),
                                 static_cast<int>(b), far, r.p_WA_p_WB);
    return r;
  }
  Result warm(const Ask& ask) { return cold(ask); }
  static Answer read(const Result& r) {
    const Vec3 v = Eigen::Map<const Vec3>(r.p_WA_p_WB + 3) - Eigen::Map<const Vec3>(r.p_WA_p_WB);
    return {.distance = r.distance, .extraction_W = v / std::copysign(v.norm(), -r.distance)};
  }

 private:
  static constexpr double far = 1e6;  ///< [m] larger than every gap of the tasks

  struct Placed {
    std::vector<double> positions, rotations;
  };

  static mjModel* compile(const Task& task) {
    const std::unique_ptr<mjSpec, void (*)(mjSpec*)> spec(mj_makeSpec(), mj_deleteSpec);
    mjsBody* world = mjs_findBody(spec.get(), "world");
    for (std::size_t i = 0; i < task.solids.size(); ++i) {
      const Solid& s = task.solids[i];
      mjsGeom* geom = mjs_addGeom(world, nullptr);
      if (s.box) {
        geom->type = mjGEOM_BOX;
        std::copy_n(s.half_extents.data(), 3, geom->size);
      } else {
        const std::string name = std::to_string(i);
        mjsMesh* mesh = mjs_addMesh(spec.get(), nullptr);
        mjs_setName(mesh->element, name.c_str());
        std::vector<float> vertices;
        for (const Vec3& v : s.vertices) {
          for (int k = 0; k < 3; ++k) vertices.push_back(static_cast<float>(v[k]));
        }
        mjs_setFloat(mesh->uservert, vertices.data(), static_cast<int>(vertices.size()));
        geom->type = mjGEOM_MESH;
        mjs_setString(geom->meshname, name.c_str());
      }
    }
    mjModel* model = mj_compile(spec.get(), nullptr);
    if (model == nullptr) throw std::runtime_error(mjs_getError(spec.get()));
    return model;
  }

  /// MuJoCo's compiler transforms a mesh to its principal axes of inertia and rounds the vertices
  /// to floats again. Restoring the original vertices, in the same order, removes that error; the
  /// hull stays.
  void keep_vertices_where_they_were() {
    for (std::size_t i = 0; i < task_.solids.size(); ++i) {
      const int mesh = model_->geom_dataid[i];
      if (mesh < 0) continue;
      const std::vector<Vec3>& given = task_.solids[i].vertices;
      if (model_->mesh_vertnum[mesh] != static_cast<int>(given.size())) {
        throw std::runtime_error("MuJoCo changed the number of vertices of a mesh");
      }
      float* vertex = model_->mesh_vert + 3 * model_->mesh_vertadr[mesh];
      for (const Vec3& v : given) {
        for (int k = 0; k < 3; ++k) *vertex++ = static_cast<float>(v[k]);
      }
    }
  }

  const Task& task_;
  std::unique_ptr<mjModel, void (*)(mjModel*)> model_;
  std::unique_ptr<mjData, void (*)(mjData*)> data_{nullptr, mj_deleteData};
  std::vector<Placed> X_W_;
};

const Enlisted enlisted({
    .name = "mujoco",
    .version = mj_versionString(),
    .settings = "mj_geomDistance, native convex collision, box and mesh geoms, default tolerance: "
                "others change neither time nor answers; keeps nothing from tick to tick",
    .tolerance = 1e-6,
    .warms = false,
    .load = Adapter<MuJoCo>::load,
});

}  // namespace

}  // namespace repel::bench
