// SPDX-License-Identifier: BSD-3-Clause
#include "physics/network/network_bound.hpp"

#include <random>

#include <Eigen/Dense>

#include "constants.hpp"
#include "ergotic/physics/certificate/monodromy.hpp"
#include "physics/network/cell_bound.hpp"
#include "physics/network/network_analysis.hpp"
#include "physics/network/network_spectrum.hpp"
#include "support/test.hpp"

namespace ergotic::physics {
namespace {
const std::vector<Share> kNothing;

std::vector<Share> between(int a, int b) {
  return {{a, 1.0}, {b, -1.0}};
}
Range exactly(double value) {
  return {value, value};
}
void spring(NetworkBound& network, const std::vector<Share>& ends, double k, double z = 0.0) {
  network.addLink(ends, exactly(k), exactly(z), static_cast<int>(network.links().size()));
}

/// Dense copies, for tests to check by themselves.
struct Dense {
  explicit Dense(const NetworkBound& network)
      : mass(network.nodes()),
        stiffness(Eigen::MatrixXd::Zero(network.nodes(), network.nodes())),
        damping(stiffness) {
    for (int i = 0; i < network.nodes(); ++i) {
      mass[i] = network.mass(i);
    }
    for (const NetworkBound::Link& link : network.links()) {
      Eigen::VectorXd u = Eigen::VectorXd::Zero(network.nodes());
      for (const Share& share : link.ends) {
        u[share.node] = share.weight;
      }
      stiffness += link.stiffness.highest * u * u.transpose();
      damping += link.damping.highest * u * u.transpose();
    }
  }
  double lambda(double h) const {
    const Eigen::VectorXd s = mass.cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd a =
        s.asDiagonal() * (h * h * stiffness + 2.0 * h * damping) * s.asDiagonal();
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a).eigenvalues().maxCoeff();
  }
  /// Of one explicit step of (x[n], x[n-1]).
  double radius(double h) const {
    const Eigen::Index n = mass.size();
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(n, n);
    const Eigen::MatrixXd z = h * mass.cwiseInverse().asDiagonal() * damping;
    Eigen::MatrixXd step(2 * n, 2 * n);
    step << 2.0 * identity - h * h * mass.cwiseInverse().asDiagonal() * stiffness - z, z - identity,
        identity, Eigen::MatrixXd::Zero(n, n);
    return spectralRadius(step);
  }
  Eigen::VectorXd mass;
  Eigen::MatrixXd stiffness;
  Eigen::MatrixXd damping;
};

/// Masses in rows and columns, all at the edge tied to fixed points, with diagonals if wanted.
NetworkBound gridOf(int rows, int columns, double kappa, bool diagonals) {
  NetworkBound network(1.0);
  const auto nodeAt = [&](int r, int c) { return r * columns + c; };
  for (int i = 0; i < rows * columns; ++i) {
    network.addNode(1.0, i);
  }
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      for (const auto& [dr, dc] : {std::pair(0, 1), {1, 0}, {1, 1}, {0, -1}, {-1, 0}}) {
        const bool is_inside = r + dr >= 0 && r + dr < rows && c + dc >= 0 && c + dc < columns;
        if (is_inside && (dr + dc == 1 || (diagonals && dr + dc == 2))) {
          spring(network, between(nodeAt(r, c), nodeAt(r + dr, c + dc)), kappa);
        } else if (!is_inside && dr * dc == 0) {
          spring(network, {{nodeAt(r, c), 1.0}}, kappa);
        }
      }
    }
  }
  return network;
}

NetworkBound randomDampedNet(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  NetworkBound network(1.0);
  const int nodes = 3 + static_cast<int>(10.0 * unit(random));
  for (int i = 0; i < nodes; ++i) {
    network.addNode(std::pow(10.0, unit(random)), i);
  }
  const auto anyNode = [&] { return static_cast<int>(unit(random) * nodes); };
  for (int l = 0; l < 2 * nodes; ++l) {
    const int a = anyNode();
    const int b = anyNode();
    const double damping = unit(random) < 0.5 ? 0.3 * unit(random) : 0.0;
    spring(network, a == b ? std::vector<Share>{{a, 1.0}} : between(a, b), unit(random), damping);
  }
  for (int i = 0; i < nodes; ++i) {
    spring(network, {{i, 1.0}}, 0.01, 0.001);  // no rigid motions
  }
  return network;
}

TEST(NetworkSpectrumTest, RandomDampedNetsAreStableUpToTheLongestStepAndNotBeyond) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    const NetworkBound network = randomDampedNet(seed);
    const Dense dense(network);
    const NetworkAnalysis analysis = analyse(network);
    ASSERT_TRUE(analysis.is_exact);
    const double exact = dense.lambda(1.0);
    EXPECT_GE(analysis.lambda, exact * (1.0 - 1e-12)) << seed;
    EXPECT_LE(analysis.lambda, exact * (1.0 + 1e-6)) << seed;
    EXPECT_LE(dense.radius(0.9999 * analysis.stable_step), 1.0 + 1e-7) << seed;
    EXPECT_GT(dense.radius(1.0001 * analysis.stable_step), 1.0 + 1e-5) << seed;
  }
}

TEST(NetworkSpectrumTest, KnowsGridsAndChainsInClosedForm) {
  for (const auto& [rows, columns] : {std::pair(1, 200), {30, 30}, {84, 84}}) {
    const double kappa = 0.49;
    const auto half = [](int n) { return std::pow(std::cos(kPi / (2.0 * (n + 1))), 2.0); };
    // A row of one has its own two springs to the sides.
    const double exact =
        4.0 * kappa * half(columns) + (rows == 1 ? 2.0 * kappa : 4.0 * kappa * half(rows));
    const NetworkAnalysis analysis = analyse(gridOf(rows, columns, kappa, false));
    EXPECT_GE(analysis.lambda, exact * (1.0 - 1e-12));
    EXPECT_LE(analysis.lambda, exact * (1.0 + 1e-6));
    EXPECT_NEAR(analysis.stable_step / std::sqrt(4.0 / exact), 1.0, 1e-6);
  }
}

TEST(NetworkSpectrumTest, KnowsTriangulatedNetsThatTheBoundsWouldRefuse) {
  NetworkBound network = gridOf(12, 12, 0.42, true);
  const double exact = Dense(network).lambda(1.0);
  ASSERT_LT(exact, 4.0);
  EXPECT_GT(network.linkBound(), 4.0);
  EXPECT_GT(network.collatzWielandtBound(20), 4.0);
  EXPECT_NEAR(analyse(network).lambda, exact, 1e-6 * exact);
  EXPECT_TRUE(analyse(network).isProven());
}

TEST(NetworkSpectrumTest, DecidesWithinATenThousandthOfTheLimit) {
  const double exact = Dense(gridOf(9, 9, 1.0, true)).lambda(1.0);
  EXPECT_TRUE(analyse(gridOf(9, 9, 3.9996 / exact, true)).isProven());
  EXPECT_FALSE(analyse(gridOf(9, 9, 4.0004 / exact, true)).isProven());
}

TEST(NetworkSpectrumTest, NamesTheLinkThatTakesMostOfTheWorstMode) {
  NetworkBound network = gridOf(6, 6, 0.2, true);
  network.addLink(between(14, 15), exactly(1.5), exactly(0.0), 4711);
  EXPECT_EQ(analyse(network).worst_link, 4711);
}

/// A net with all its cells: rows x columns free nodes, sides and diagonals.
NetworkBound net(int rows,
                 int columns,
                 const std::function<double()>& side,
                 const std::function<double()>& diagonal,
                 const std::function<double()>& mass) {
  NetworkBound network(1.0);
  for (int i = 0; i < rows * columns; ++i) {
    network.addNode(mass(), i);
  }
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const int here = r * columns + c;
      if (c + 1 < columns) {
        spring(network, between(here, here + 1), side(), 0.1 * side());
      }
      if (r + 1 < rows) {
        spring(network, between(here, here + columns), side());
      }
      if (r + 1 < rows && c + 1 < columns) {
        spring(network, between(here, here + columns + 1), diagonal());
        spring(network, between(here + 1, here + columns), diagonal());
        network.addCell({here, here + 1, here + columns, here + columns + 1});
      }
    }
  }
  return network;
}

TEST(CellBoundTest, IsExactInTheLimitForNetsWithDiagonals) {
  const auto one = [] { return 1.0; };
  const auto half = [] { return 0.5; };
  const auto none = [] { return 0.0; };
  NetworkBound network = net(16, 16, none, none, one);
  const NetworkBound plain = net(16, 16, one, half, one);
  // sides 1 with a damping of 0.1 along rows: h^2 k + 2 h z = 1.2 and 1, diagonals 0.5
  const double exact = Dense(plain).lambda(1.0);
  EXPECT_GE(cellBound(plain), exact);
  EXPECT_LT(cellBound(plain), 1.03 * exact);
  EXPECT_GT(plain.linkBound(), 1.3 * exact);
  EXPECT_EQ(cellBound(network), 0.0);
}

TEST(CellBoundTest, StaysAboveTheEigenvalueOfRandomNetsWithLooseLinksAndWeights) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(0.01, 1.0);
  for (int n = 0; n < 50; ++n) {
    const auto any = [&] { return number(random); };
    NetworkBound network = net(2 + n % 5, 3 + n % 3, any, any, any);
    const int last = network.nodes() - 1;
    spring(network, between(0, last), any());
    spring(network, {{0, 0.3}, {1, 0.7}, {last, -1.0}}, any());
    spring(network, {{n % network.nodes(), 1.0}}, any());
    const double exact = Dense(network).lambda(1.0);
    EXPECT_GE(cellBound(network), exact * (1.0 - 1e-12)) << n;
    EXPECT_LE(cellBound(network), network.linkBound() * (1.0 + 1e-9)) << n;
    EXPECT_LE(rayleighQuotient(network, 60), exact * (1.0 + 1e-12)) << n;
    EXPECT_GE(rayleighQuotient(network, 60), 0.9 * exact) << n;
  }
}

TEST(CellBoundTest, WithoutCellsIsTheLinkBound) {
  NetworkBound chain(0.5);
  for (int i = 0; i < 5; ++i) {
    chain.addNode(1.0 + i, i);
  }
  for (int i = 0; i + 1 < 5; ++i) {
    spring(chain, between(i, i + 1), 3.0 - 0.5 * i, 0.1);
  }
  EXPECT_NEAR(cellBound(chain), chain.linkBound(), 1e-9);
}

TEST(NetworkAnalysisTest, LargeNetsWithDiagonalsAreProvenByTheirCellsAndRefutedByAMode) {
  for (const double k : {0.45, 0.55}) {
    const auto side = [&] { return k / 1.1; };  // lambda = 8 k / 1.1 at most, damping on top
    const NetworkBound network = net(
        150, 150, side, [&] { return 0.5 * side(); }, [] { return 1.0; });
    const NetworkAnalysis analysis = analyse(network);
    EXPECT_FALSE(analysis.is_exact);
    EXPECT_FALSE(analysis.is_too_large);
    EXPECT_EQ(analysis.isProven(), k < 0.5) << analysis.lambda;
    EXPECT_GT(analysis.link_bound, NetworkBound::kLimit);
    EXPECT_EQ(analysis.stable_step > network.step(), k < 0.5);
  }
}

TEST(NetworkBoundTest, IsExactForOneLoadWithWeights) {
  NetworkBound network(1.0);
  for (const double mass : {1.0, 2.0, 4.0}) {
    network.addNode(mass, 0);
  }
  spring(network, {{0, 0.7}, {1, 0.3}, {2, -1.0}}, 2.0);
  const double exact = 2.0 * (0.49 / 1.0 + 0.09 / 2.0 + 1.0 / 4.0);
  EXPECT_GE(network.linkBound(), exact * (1.0 - 1e-12));
  EXPECT_GE(network.collatzWielandtBound(20), exact * (1.0 - 1e-12));
  EXPECT_NEAR(network.collatzWielandtBound(200), exact, 1e-9);
  EXPECT_NEAR(analyse(network).lambda, exact, 1e-6 * exact);
}

TEST(NetworkBoundTest, StaysAboveTheEigenvalueOfRandomWeightedNets) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    NetworkBound network = randomDampedNet(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int l = 0; l < 3; ++l) {
      const double f = unit(random);
      spring(network, {{0, 1.0 - f}, {1, f}, {2, -1.0}}, 3.0 * unit(random), unit(random));
    }
    const double exact = Dense(network).lambda(1.0) * (1.0 - 1e-12);
    EXPECT_GE(network.linkBound(), exact) << seed;
    EXPECT_GE(network.collatzWielandtBound(20), exact) << seed;
    EXPECT_GE(analyse(network).lambda, exact) << seed;
  }
}

TEST(NetworkBoundTest, SharesOfOneNodeAddUp) {
  NetworkBound network(1.0);
  network.addNode(1.0, 0);
  network.addNode(1.0, 0);
  spring(network, {{0, 0.5}, {1, 0.5}, {0, -0.25}, {1, -0.75}}, 8.0);
  EXPECT_NEAR(network.linkBound(), 8.0 * (0.25 * 0.25 * 2.0), 1e-12);
  spring(network, {{0, 1.0}, {0, -1.0}}, 1e9);
  spring(network, kNothing, 1e9);
  EXPECT_EQ(network.links().size(), 1u);
}

/// A finger of stiffness 0.4 that slides along a chain, here standing still between two masses.
TEST(NetworkSpectrumTest, AMovingLinkIsAsBadAsItsWorstPlaceAndNoWorse) {
  const auto chain = [] { return gridOf(1, 30, 0.45, false); };
  NetworkBound moving = chain();
  std::vector<std::vector<Share>> places;
  for (int i = 0; i < 30; ++i) {
    places.push_back({{i, 1.0}});
  }
  moving.addMovingLink(places, 0.4, 0.1, 7);
  double worst = 0.0;
  for (double place = 0.0; place < 29.0; place += 0.25) {
    NetworkBound still = chain();
    const int i = static_cast<int>(place);
    spring(still, {{i, 1.0 - (place - i)}, {i + 1, place - i}}, 0.4, 0.1);
    worst = std::max(worst, Dense(still).lambda(1.0));
  }
  const NetworkAnalysis analysis = analyse(moving);
  EXPECT_GE(analysis.lambda, worst * (1.0 - 1e-12));
  EXPECT_LE(analysis.lambda, worst * (1.0 + 1e-6));
  EXPECT_GT(moving.withMovingEverywhere().linkBound(), worst);
  EXPECT_TRUE(analysis.is_exact);
}

TEST(NetworkSpectrumTest, TwoMovingLinksAreBoundedFromAbove) {
  NetworkBound moving = gridOf(1, 12, 0.4, false);
  std::vector<std::vector<Share>> places;
  for (int i = 0; i < 12; ++i) {
    places.push_back({{i, 1.0}});
  }
  moving.addMovingLink(places, 0.3, 0.0, 7);
  moving.addMovingLink(places, 0.2, 0.0, 8);
  double worst = 0.0;
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j) {
      NetworkBound still = gridOf(1, 12, 0.4, false);
      spring(still, {{i, 1.0}}, 0.3);
      spring(still, {{j, 1.0}}, 0.2);
      worst = std::max(worst, Dense(still).lambda(1.0));
    }
  }
  const NetworkAnalysis analysis = analyse(moving);
  EXPECT_GE(analysis.lambda, worst * (1.0 - 1e-12));
  EXPECT_LE(analysis.lambda, 1.05 * worst);
  EXPECT_TRUE(analysis.is_bound);
  EXPECT_FALSE(analysis.is_exact);
}

/// What slides can pull at another module: bounded by both by themselves.
TEST(NetworkBoundTest, MovingEverywhereCoversEveryPlace) {
  NetworkBound moving = gridOf(1, 10, 0.3, false);
  const int body = moving.addNode(3.0, 0);
  std::vector<std::vector<Share>> places;
  for (int i = 2; i < 8; ++i) {
    places.push_back({{i, 1.0}, {body, -1.0}});
  }
  moving.addMovingLink(places, 0.9, 0.2, 7);
  const NetworkBound everywhere = moving.withMovingEverywhere();
  for (double place = 2.0; place < 7.0; place += 0.1) {
    NetworkBound still = gridOf(1, 10, 0.3, false);
    still.addNode(3.0, 0);
    const int i = static_cast<int>(place);
    spring(still, {{i, 1.0 - (place - i)}, {i + 1, place - i}, {body, -1.0}}, 0.9, 0.2);
    EXPECT_GE(Dense(everywhere).lambda(1.0), Dense(still).lambda(1.0));
  }
}

/// With one place only it is the spring-damper itself.
TEST(NetworkBoundTest, MovingEverywhereLoadsBothEndsAsTheirSpringDoes) {
  NetworkBound moving = gridOf(1, 2, 1e-4, false);
  moving.addMovingLink({{{0, 1.0}, {1, -1.0}}}, 0.9, 0.1, 7);
  EXPECT_NEAR(Dense(moving.withMovingEverywhere()).lambda(1.0), 2.2, 1e-3);
  EXPECT_NEAR(analyse(moving).stable_step, 1.3837, 1e-3);  // 2 (0.9 h^2 + 0.2 h) = 4
}

TEST(NetworkSpectrumTest, NegativeSpringsAreFineWhereTheRestMakesUpForThem) {
  const auto pair = [](double own, double between_them) {
    NetworkBound network(1.0);
    network.addNode(1.0, 0);
    network.addNode(1.0, 0);
    spring(network, {{0, 1.0}}, own);
    spring(network, {{1, 1.0}}, own);
    spring(network, between(0, 1), between_them);
    return network;
  };
  EXPECT_TRUE(semidefiniteBesideNegative(pair(1.0, -0.49)));
  EXPECT_FALSE(semidefiniteBesideNegative(pair(1.0, -0.5))) << "rounding decides whether it grows";
  EXPECT_FALSE(semidefiniteBesideNegative(pair(1.0, -0.51)));
  EXPECT_GT(Dense(pair(1.0, -0.51)).radius(1.0), 1.05);
  EXPECT_LE(Dense(pair(1.0, -0.49)).radius(1.0), 1.0 + 1e-9);
  EXPECT_NEAR(analyse(pair(1.0, -0.49)).lambda, 1.0, 1e-6);
}

TEST(NetworkSpectrumTest, DampingMustBeSemidefiniteByItself) {
  NetworkBound network(1.0);
  network.addNode(1.0, 0);
  spring(network, {{0, 1.0}}, 1.0, -0.1);
  EXPECT_GT(Dense(network).lambda(1.0), 0.0);
  EXPECT_LT(Dense(network).lambda(1.0), 4.0);
  EXPECT_FALSE(semidefiniteBesideNegative(network));
  EXPECT_GT(Dense(network).radius(1.0), 1.04);
}

TEST(NetworkSpectrumTest, KnowsWhatOverflows) {
  NetworkBound network(1.0);
  network.addNode(1e-320, 0);
  network.addNode(1e-320, 1);
  spring(network, between(0, 1), 1e300);
  EXPECT_FALSE(NetworkSpectrum(network).isFinite());
  EXPECT_FALSE(analyse(network).isProven());
}

}  // namespace
}  // namespace ergotic::physics
