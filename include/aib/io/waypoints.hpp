// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/file.hpp>
#include <aib/io/file_kind.hpp>
#include <aib/math/geodesy.hpp>
#include <aib/math/rotation.hpp>
#include <aib/pose/trajectory.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace aib::io {

struct waypoint_options {
  math::geodetic origin = {};  ///< of the poses: x east, y north, z up
  double speed = 2;            ///< m/s
};

/// Where a drone flies and how its camera is turned, angles in degrees.
struct waypoint {
  std::string name;
  Eigen::Vector3d local;  ///< east, north, up, m
  double latitude, longitude;
  double altitude;  ///< m above the ellipsoid
  double heading;   ///< of the view, clockwise from north, 0..360
  double pitch;     ///< of the view, negative looks down
};

/// Waypoints of the registered poses of a trajectory.
[[nodiscard]] std::vector<waypoint> waypoints(const pose::trajectory& t,
                                              const waypoint_options& options);

/// Writes waypoints: .csv (a line each), .kml (a line and its places, for a look at them on a map)
/// or .plan (QGroundControl: take-off, and for each pose gimbal, waypoint and picture; heights
/// count from the origin).
///
/// Throws argument_error for another extension, an origin that is no place, or where no pose is
/// registered.
void write_waypoints(const std::filesystem::path& path,
                     const pose::trajectory& t,
                     const waypoint_options& options);

namespace detail {

inline std::string csv_of(const std::vector<waypoint>& points) {
  std::string out = "name,latitude,longitude,altitude,east,north,up,heading_deg,pitch_deg\n";
  for (const waypoint& w : points) {
    out += message(w.name, ",", w.latitude, ",", w.longitude, ",", w.altitude, ",", w.local.x(),
                   ",", w.local.y(), ",", w.local.z(), ",", w.heading, ",", w.pitch, "\n");
  }
  return out;
}

inline std::string xml_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

inline std::string kml_of(const std::vector<waypoint>& points) {
  const auto place = [](const waypoint& w) {
    return message(w.longitude, ",", w.latitude, ",", w.altitude);
  };
  std::string out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n"
      "<Placemark><name>flight</name><LineString><altitudeMode>absolute</altitudeMode>"
      "<coordinates>\n";
  for (const waypoint& w : points) out += place(w) + "\n";
  out += "</coordinates></LineString></Placemark>\n";
  for (const waypoint& w : points) {
    out += message("<Placemark><name>", xml_text(w.name), "</name><Camera><longitude>", w.longitude,
                   "</longitude><latitude>", w.latitude, "</latitude><altitude>", w.altitude,
                   "</altitude><heading>", w.heading, "</heading><tilt>", 90 + w.pitch,
                   "</tilt><altitudeMode>absolute</altitudeMode></Camera><Point><altitudeMode>"
                   "absolute</altitudeMode><coordinates>",
                   place(w), "</coordinates></Point></Placemark>\n");
  }
  return out + "</Document>\n</kml>\n";
}

/// A mission in the words of MAVLink's commands.
/// Source: QGroundControl developer guide, "Plan File Format"; MAVLink common message set.
class qgc_plan {
 public:
  explicit qgc_plan(const waypoint_options& options) : options_(options) {}

  std::string text(const std::vector<waypoint>& points) {
    constexpr int take_off = 22, go_to = 16, turn_gimbal = 205, take_picture = 2000;
    const std::string at = place(points.front());
    add(take_off, 3, message("0, 0, 0, null, ", at));
    for (const waypoint& w : points) {
      add(turn_gimbal, 2, message(w.pitch, ", 0, 0, 0, 0, 0, 2"));
      add(go_to, 3, message("0, 0, 0, ", w.heading, ", ", place(w)));
      add(take_picture, 2, "0, 0, 1, 0, 0, 0, 0");
    }
    const auto& [latitude, longitude, altitude] = options_.origin;
    return message(
        "{\n\"fileType\": \"Plan\", \"version\": 1, \"groundStation\": \"QGroundControl\",\n",
        "\"geoFence\": {\"circles\": [], \"polygons\": [], \"version\": 2},\n",
        "\"rallyPoints\": {\"points\": [], \"version\": 2},\n",
        "\"mission\": {\n\"version\": 2, \"firmwareType\": 12, \"vehicleType\": 2, ",
        "\"cruiseSpeed\": ", options_.speed, ", \"hoverSpeed\": ", options_.speed,
        ",\n\"plannedHomePosition\": [", math::degrees(latitude), ", ", math::degrees(longitude),
        ", ", altitude, "],\n\"items\": [\n", items_, "\n]}}\n");
  }

 private:
  static std::string place(const waypoint& w) {
    return message(w.latitude, ", ", w.longitude, ", ", w.local.z());
  }
  void add(int command, int frame, const std::string& params) {
    ++n_;
    if (n_ > 1) items_ += ",\n";
    items_ +=
        message("{\"type\": \"SimpleItem\", \"autoContinue\": true, \"command\": ", command,
                ", \"doJumpId\": ", n_, ", \"frame\": ", frame, ", \"params\": [", params, "]}");
  }

  const waypoint_options& options_;
  std::string items_;
  int n_ = 0;
};

}  // namespace detail

inline std::vector<waypoint> waypoints(const pose::trajectory& t, const waypoint_options& options) {
  std::vector<waypoint> points;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const math::rigid3& pose = t.world_from_camera[i];
    if (!pose.is_finite()) continue;
    const math::geodetic g = math::geodetic_from_local(pose.translation, options.origin);
    const Eigen::Vector3d view = pose.rotation.col(2);
    const double heading = math::degrees(std::atan2(view.x(), view.y()));
    points.push_back({t.names.empty() ? std::to_string(i) : t.names[i], pose.translation,
                      math::degrees(g.latitude), math::degrees(g.longitude), g.altitude,
                      heading < 0 ? heading + 360 : heading,
                      math::degrees(std::asin(std::clamp(view.z(), -1.0, 1.0)))});
  }
  return points;
}

inline void write_waypoints(const std::filesystem::path& path,
                            const pose::trajectory& t,
                            const waypoint_options& options) {
  const math::geodetic& o = options.origin;
  if (!(std::abs(o.latitude) <= math::radians(90)) ||
      !(std::abs(o.longitude) <= math::radians(360)) || !std::isfinite(o.altitude) ||
      !(options.speed > 0))
    throw argument_error(
        "io::write_waypoints: a latitude of -90..90, a longitude of -360..360, an "
        "altitude and a speed above 0 expected");
  const std::vector<waypoint> points = waypoints(t, options);
  if (points.empty()) throw argument_error("io::write_waypoints: no pose is registered");
  const std::string extension = extension_of(path);
  if (extension == ".csv") return write_file(path, detail::csv_of(points));
  if (extension == ".kml") return write_file(path, detail::kml_of(points));
  if (extension == ".plan") return write_file(path, detail::qgc_plan(options).text(points));
  throw argument_error(message("io::write_waypoints: the extension .csv, .kml or .plan expected, ",
                               "found \"", path.extension().string(), "\""));
}

}  // namespace aib::io
