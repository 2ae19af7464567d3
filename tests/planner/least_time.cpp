#include "least_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace trammel::test {
namespace {

using planner::Span;

struct Grid {
  std::vector<double> step;          // length of each interval, mm
  std::vector<double> acceleration;  // limits in each interval
  std::vector<double> jerk;
  std::vector<double> most;  // largest square of the speed at each node
  std::vector<std::size_t> span;
};

// Unknowns are the squares of the speeds at nodes, b_0 .. b_n; the acceleration between nodes is constant. Minimises
// the time by Newton's method with logarithmic barriers at the limits.
class Interior {
 public:
  Interior(const Grid& grid, std::vector<double> squares) : grid_(grid), b_(std::move(squares)) {}

  double seconds() const { return seconds_of(b_); }
  const std::vector<double>& squares() const { return b_; }

  void solve(double share) {
    const double count = 8 * static_cast<double>(b_.size());
    for (weight_ = seconds() / count;; weight_ /= 4) {
      for (int i = 0; i < 60; ++i) {
        if (!step()) break;
      }
      if (weight_ * count < share * seconds()) return;
    }
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  std::size_t intervals() const { return grid_.step.size(); }
  static double pass(double h, double low, double high) { return 2 * h / (std::sqrt(low) + std::sqrt(high)); }
  double seconds_of(const std::vector<double>& b) const {
    double sum = 0;
    for (std::size_t k = 0; k < intervals(); ++k) sum += pass(grid_.step[k], b[k], b[k + 1]);
    return sum;
  }
  double acceleration(const std::vector<double>& b, std::size_t k) const {
    return (b[k + 1] - b[k]) / (2 * grid_.step[k]);
  }

  // Largest change of the acceleration at node k: the jerk limit over half of each interval beside it.
  double swing(const std::vector<double>& b, std::size_t k) const {
    double sum = 0;
    if (k > 0) sum += grid_.jerk[k - 1] * pass(grid_.step[k - 1], b[k - 1], b[k]) / 2;
    if (k < intervals()) sum += grid_.jerk[k] * pass(grid_.step[k], b[k], b[k + 1]) / 2;
    return sum;
  }
  double change(const std::vector<double>& b, std::size_t k) const {
    return (k < intervals() ? acceleration(b, k) : 0) - (k > 0 ? acceleration(b, k - 1) : 0);
  }

  // Time with barriers; infinite outside the limits.
  double merit(const std::vector<double>& b) const {
    double sum = 0;
    double logs = 1;
    double exponent = 0;
    const auto slack = [&](double value) {
      if (!(value > 0)) return false;
      logs *= value;
      int e;
      logs = std::frexp(logs, &e);
      exponent += e;
      return true;
    };
    for (std::size_t k = 1; k + 1 < b.size(); ++k) {
      if (!slack(b[k]) || !slack(grid_.most[k] - b[k])) return kNone;
    }
    for (std::size_t k = 0; k < intervals(); ++k) {
      const double a = acceleration(b, k);
      if (!slack(grid_.acceleration[k] - a) || !slack(grid_.acceleration[k] + a)) return kNone;
    }
    for (std::size_t k = 0; k < b.size(); ++k) {
      const double s = swing(b, k);
      const double c = change(b, k);
      if (!slack(s - c) || !slack(s + c)) return kNone;
    }
    sum = seconds_of(b) - weight_ * (std::log(logs) + exponent * 0.6931471805599453);
    return sum;
  }

  // Gradient, and a positive Hessian in bands of 3. The non-convex terms of the barriers at the jerk limits are left
  // out.
  void differentiate() {
    const std::size_t n = b_.size();
    g_.assign(n, 0);
    h_.assign(n, {});
    const auto barrier = [&](std::size_t first, std::size_t count, const double* d, double slack) {
      for (std::size_t i = 0; i < count; ++i) {
        g_[first + i] -= weight_ * d[i] / slack;
        for (std::size_t j = 0; j <= i; ++j) h_[first + i][i - j] += weight_ * d[i] * d[j] / (slack * slack);
      }
    };
    for (std::size_t k = 1; k + 1 < n; ++k) {
      const double up = 1, down = -1;
      barrier(k, 1, &up, b_[k]);
      barrier(k, 1, &down, grid_.most[k] - b_[k]);
    }
    for (std::size_t k = 0; k < intervals(); ++k) {
      const double part = 1 / (2 * grid_.step[k]);
      const double rise[2] = {-part, part}, fall[2] = {part, -part};
      const double a = acceleration(b_, k);
      barrier(k, 2, fall, grid_.acceleration[k] - a);
      barrier(k, 2, rise, grid_.acceleration[k] + a);
      time(k);
    }
    for (std::size_t k = 0; k < n; ++k) {
      double ds[3] = {}, dc[3] = {};
      if (k > 0) {
        const auto d = pass_gradient(k - 1);
        ds[0] += grid_.jerk[k - 1] * d[0] / 2;
        ds[1] += grid_.jerk[k - 1] * d[1] / 2;
        dc[0] += 1 / (2 * grid_.step[k - 1]);
        dc[1] -= 1 / (2 * grid_.step[k - 1]);
      }
      if (k < intervals()) {
        const auto d = pass_gradient(k);
        ds[1] += grid_.jerk[k] * d[0] / 2;
        ds[2] += grid_.jerk[k] * d[1] / 2;
        dc[1] -= 1 / (2 * grid_.step[k]);
        dc[2] += 1 / (2 * grid_.step[k]);
      }
      const double s = swing(b_, k), c = change(b_, k);
      double minus[3], plus[3];
      for (int i = 0; i < 3; ++i) minus[i] = ds[i] - dc[i], plus[i] = ds[i] + dc[i];
      const std::size_t skip = k == 0 ? 1 : 0, count = 3 - skip - (k == intervals() ? 1 : 0);
      barrier(k - 1 + skip, count, minus + skip, s - c);
      barrier(k - 1 + skip, count, plus + skip, s + c);
    }
  }
  std::array<double, 2> pass_gradient(std::size_t k) const {
    const double x = std::sqrt(b_[k]), y = std::sqrt(b_[k + 1]), sum = x + y;
    const double d = -grid_.step[k] / (sum * sum);
    return {x > 0 ? d / x : 0, y > 0 ? d / y : 0};
  }
  void time(std::size_t k) {
    const double x = std::sqrt(b_[k]), y = std::sqrt(b_[k + 1]), sum = x + y, h = grid_.step[k];
    const auto d = pass_gradient(k);
    g_[k] += d[0];
    g_[k + 1] += d[1];
    // f = 2 h / s: f_xx over b: h / s^3 / x^2 + h / (2 s^2 x^3)
    if (x > 0) h_[k][0] += h / (sum * sum * sum) / (x * x) + h / (2 * sum * sum * x * x * x);
    if (y > 0) h_[k + 1][0] += h / (sum * sum * sum) / (y * y) + h / (2 * sum * sum * y * y * y);
    if (x > 0 && y > 0) h_[k + 1][1] += h / (sum * sum * sum) / (x * y);
  }

  bool step() {
    differentiate();
    const std::size_t n = b_.size();
    // The speeds at the ends stay 0.
    std::vector<std::array<double, 3>> l(n);
    std::vector<double> d(n, 0);
    for (std::size_t i = 1; i + 1 < n; ++i) {
      for (std::size_t j = (i >= 3 ? i - 2 : 1); j <= i; ++j) {
        double sum = h_[i][i - j];
        for (std::size_t m = (i >= 3 ? i - 2 : 1); m < j; ++m)
          if (j - m <= 2) sum -= l[i][i - m] * l[j][j - m];
        l[i][i - j] = i == j ? std::sqrt(std::max(sum, 1e-300)) : sum / l[j][0];
      }
    }
    for (std::size_t i = 1; i + 1 < n; ++i) {
      double sum = -g_[i];
      for (std::size_t m = 1; m <= 2 && i > m; ++m) sum -= l[i][m] * d[i - m];
      d[i] = sum / l[i][0];
    }
    double decrement = 0;
    for (std::size_t i = 1; i + 1 < n; ++i) decrement += d[i] * d[i];
    for (std::size_t i = n - 2; i > 0; --i) {
      double sum = d[i];
      for (std::size_t m = 1; m <= 2 && i + m + 1 < n; ++m) sum -= l[i + m][m] * d[i + m];
      d[i] = sum / l[i][0];
    }
    if (!(decrement > 0.1 * weight_)) return false;
    const double now = merit(b_);
    std::vector<double> next(n);
    for (double length = 1; length > 1e-12; length /= 2) {
      for (std::size_t i = 0; i < n; ++i) next[i] = b_[i] + length * d[i];
      if (merit(next) < now - 0.1 * length * decrement) {
        b_.swap(next);
        return true;
      }
    }
    return false;
  }

  const Grid& grid_;
  std::vector<double> b_;
  double weight_ = 0;
  std::vector<double> g_;
  std::vector<std::array<double, 3>> h_;  // row i: (i, i), (i, i - 1), (i, i - 2)
};

// Nodes at the shares, 0 .. 1, of each span.
Grid grid_of(const std::vector<Span>& spans, const std::vector<std::vector<double>>& shares) {
  Grid grid;
  for (std::size_t i = 0; i < spans.size(); ++i) {
    const Span& span = spans[i];
    for (std::size_t k = 0; k + 1 < shares[i].size(); ++k) {
      double most = span.speed;
      if (k == 0 && i > 0) most = std::min({most, spans[i - 1].speed, spans[i - 1].exit_speed});
      grid.most.push_back(most * most);
      grid.step.push_back(span.length * (shares[i][k + 1] - shares[i][k]));
      grid.acceleration.push_back(span.acceleration);
      grid.jerk.push_back(span.jerk);
      grid.span.push_back(i);
    }
  }
  grid.most.push_back(0);
  return grid;
}

// Squares of the speeds at the nodes for a single move well within all limits.
std::vector<double> slow_start(const Grid& grid) {
  double length = 0, speed = std::numeric_limits<double>::infinity(), acceleration = speed, jerk = speed;
  for (std::size_t k = 0; k < grid.step.size(); ++k) {
    length += grid.step[k];
    if (k > 0) speed = std::min(speed, std::sqrt(grid.most[k]));
    acceleration = std::min(acceleration, grid.acceleration[k]);
    jerk = std::min(jerk, grid.jerk[k]);
  }
  std::vector<double> squares{0};
  double place = 0;
  // v^2 = 0.3 * top^2 * sin^(4/3): near rest v is proportional to s^(2/3), as under constant jerk.
  const double pi = 3.14159265358979323846;
  double top = std::min({speed, std::sqrt(acceleration * length) / pi, std::cbrt(jerk * length * length) / (2 * pi)});
  for (std::size_t k = 0; k < grid.step.size(); ++k) {
    place += grid.step[k];
    const double sine = std::sin(pi * std::min(1.0, place / length));
    squares.push_back(0.3 * top * top * std::pow(std::max(0.0, sine), 4.0 / 3));
  }
  squares.back() = 0;
  return squares;
}

}  // namespace

double least_seconds(const std::vector<Span>& spans, std::size_t nodes) {
  std::vector<std::vector<double>> shares(spans.size());
  const std::size_t each = std::max<std::size_t>(12, nodes / spans.size() / 2);
  for (auto& span : shares) {
    for (std::size_t k = 0; k <= each; ++k) {
      const double u = static_cast<double>(k) / static_cast<double>(each);
      span.push_back(u * u * u * (10 + u * (6 * u - 15)));
    }
  }
  Grid grid = grid_of(spans, shares);
  Interior coarse(grid, slow_start(grid));
  coarse.solve(1e-2);
  // Nodes at equal time intervals of the coarse solution.
  const std::vector<double>& b = coarse.squares();
  const double seconds = coarse.seconds();
  std::size_t k = 0;
  for (std::size_t i = 0; i < spans.size(); ++i) {
    std::vector<double> time{0}, place{0};
    for (; k < grid.step.size() && grid.span[k] == i; ++k) {
      time.push_back(time.back() + 2 * grid.step[k] / (std::sqrt(b[k]) + std::sqrt(b[k + 1])));
      place.push_back(place.back() + grid.step[k]);
    }
    const auto count =
        static_cast<std::size_t>(std::max(8.0, std::ceil(static_cast<double>(nodes) * time.back() / seconds)));
    std::vector<double> fine{0};
    std::size_t at = 0;
    for (std::size_t n = 1; n < count; ++n) {
      const double t = time.back() * static_cast<double>(n) / static_cast<double>(count);
      while (time[at + 1] < t) ++at;
      const double u = (t - time[at]) / (time[at + 1] - time[at]);
      const std::size_t node = k - (place.size() - 1) + at;
      const double v0 = std::sqrt(b[node]), v1 = std::sqrt(b[node + 1]);
      const double h = place[at + 1] - place[at];
      const double s = h * (2 * v0 * u + (v1 - v0) * u * u) / (v0 + v1);
      fine.push_back((place[at] + s) / place.back());
    }
    fine.push_back(1);
    shares[i] = fine;
  }
  grid = grid_of(spans, shares);
  Interior fine(grid, slow_start(grid));
  fine.solve(1e-4);
  return fine.seconds();
}

}  // namespace trammel::test
