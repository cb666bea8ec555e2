// SPDX-License-Identifier: BSD-3-Clause
#include "parent.hpp"

#include <string>

#include <repel/record/mcap_writer.hpp>

double parent::record(const repel::Vec3& velocity, const repel::Vec3& force, const char* path) {
  const double power = velocity.dot(force);
  repel::record::McapWriter writer(path);
  const auto schema = writer.add_schema("Power", "jsonschema", R"({"type": "object"})");
  writer.write(writer.add_channel("power", schema, "json"), 0, 0,
               "{\"power_w\": " + std::to_string(power) + "}");
  writer.close();
  return writer.failed() ? 0.0 : power;
}
