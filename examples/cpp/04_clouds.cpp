// Both distances and every score of two clouds in one pass.
#include <aib/cloud/compare.hpp>

#include <cstdio>
#include <vector>

int main() {
  std::vector<Eigen::Vector3f> wall;
  std::vector<Eigen::Vector3f> scan;
  for (int i = 0; i < 10000; ++i) {
    const Eigen::Vector3f p(0.01F * float(i % 100), 0, 0.01F * float(i / 100));
    wall.push_back(p);
    if (p.x() < 0.8F) scan.push_back(p + Eigen::Vector3f(0, 0.002F, 0));  // the rest was not seen
  }
  const auto scores = aib::cloud::compare({.points = scan}, {.points = wall}, {.tau = {0.005}});
  std::printf("accuracy %.4f, completeness %.4f\n", scores.accuracy, scores.completeness);
  std::printf("precision %.3f, recall %.3f, F-score %.3f\n", scores.scores[0].precision,
              scores.scores[0].recall, scores.scores[0].f_score);
}
