// One specialisation teaches aib a point type of yours.
#include <aib/cloud/compare.hpp>

#include <cstdio>
#include <vector>

struct station {
  double east, north, height;
  int code;
};

template <>
struct aib::point_traits<station> {
  using scalar = double;
  static double coordinate(const station& s, int axis) {
    return axis == 0 ? s.east : axis == 1 ? s.north : s.height;
  }
};

int main() {
  const std::vector<station> measured = {{691234.501, 5335678.250, 512.113, 7}};
  const std::vector<station> planned = {{691234.500, 5335678.250, 512.110, 7}};
  const auto scores =
      aib::cloud::compare(aib::cloud::from_points(measured), aib::cloud::from_points(planned));
  std::printf("%.1f mm, in map coordinates\n", 1000 * scores.accuracy);
}
