// Long work reports its share and can be stopped from anywhere.
#include <aib/cloud/distances.hpp>

#include <cstdio>

int main() {
  aib::cloud::cloud grid;
  for (int i = 0; i < 300000; ++i)
    grid.points.emplace_back(float(i % 67), float(i / 67 % 67), float(i / 4489));

  double last = 0;
  std::stop_source stop;
  const aib::control watch{.stop = stop.get_token(),
                           .progress = [&](double share) { last = share; }};
  const aib::cloud::distances all(grid, grid, {.control = watch});
  std::printf("largest %g, at the end %g\n", all.max(), last);

  stop.request_stop();
  try {
    const aib::cloud::distances none(grid, grid, {.control = watch});
  } catch (const aib::stopped_error& e) {
    std::printf("%s\n", e.what());
  }
}
