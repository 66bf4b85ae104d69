// Errors of a depth map that is an array of yours: a view is a pointer, two sizes and a stride.
#include <aib/depth/errors.hpp>

#include <cstdio>
#include <vector>

int main() {
  const std::size_t width = 4;
  const std::size_t height = 2;
  const std::vector<float> estimate = {2.0F, 2.1F, 3.9F, 4.0F, 0, 5.0F, 6.2F, 8.0F};
  const std::vector<float> truth = {2.0F, 2.0F, 4.0F, 4.0F, 5.0F, 5.0F, 6.0F, 8.0F};

  using view = aib::raster::view<const float>;
  const auto errors = aib::depth::errors(view{estimate.data(), width, height, width},
                                         view{truth.data(), width, height, width});
  std::printf("abs_rel %.4f, rmse %.4f, sRMSE %.6f\n", errors.abs_rel, errors.rmse, errors.srmse);
  std::printf("%d of %d pixels are covered\n", int(errors.n_valid), int(errors.n_reference));
}
