// Files of every format by one function a kind; warnings say what a reader repaired.
#include <aib/io/mesh.hpp>
#include <aib/io/trajectory.hpp>
#include <aib/mesh/distances.hpp>
#include <aib/sample/mesh.hpp>

#include <cstdio>

int main() {
  const auto poses = aib::io::read_trajectory("examples/data/gt/crane/poses");
  const auto mesh = aib::io::read_mesh("examples/data/gt/crane/mesh.ply");
  const auto samples = aib::sample::mesh(mesh, {.n = 1000, .seed = 7});
  const auto distances = aib::mesh::distances(samples.points, mesh);
  std::printf("%zu poses, first %s\n", poses.size(), poses.names.front().c_str());
  std::printf("%zu triangles, %.0f square metres\n", mesh.triangles.size(), samples.area);
  std::printf("samples lie on the surface to %s\n", distances.max() < 1e-5 ? "10 um" : "more");
}
