// Light cells: the planes that lists store, and the cells in which a plane is listed.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "certify/light_cells_text.h"
#include "certify/theorem.h"

namespace lightgrid::certify {
namespace {

const std::array<std::string, 3> axes{"x", "y", "z"};
constexpr double lookup_error = 4.0001 * u, side_error = 3.0001 * u;

// ---- The planes ----

using Compared = std::set<std::tuple<int, char, int>>;
Compared compared(size_t first = 0) {
  Compared all;
  const auto& choices = recorder.path().choices;
  for (size_t i = first; i < choices.size(); ++i) all.insert({choices[i].a, choices[i].op, choices[i].b});
  return all;
}

struct Tests {
  Compared listed, traced;
};

// What the lists compare for a triangle and a ray, from the corners on, and what the tree compares.
Tests compared_for(bool point) {
  RayTriangle triangle{};
  for (size_t k = 0; k < 3; ++k) {
    triangle.normal[k] = input("n" + axes[k]);
    for (size_t corner = 0; corner < 3; ++corner)
      triangle.corners[3 * corner + k] = input("c" + std::to_string(corner) + axes[k]);
  }
  LightCellJob job{};
  job.x = input("lx");
  job.y = input("ly");
  job.z = input("lz");
  job.w = point ? 1 : 0;
  job.reach_m = input("reach");
  job.grid.top = -2.0f;
  const RaySource light{job.x, job.y, job.z, job.w};
  const Real3 to{input("x"), input("y"), input("z")};
  const Real gap = input("gap");
  Tests tests;
  SeenTriangles seen;
  const int place = 0;
  auto& choices = recorder.path().choices;
  if (point) {
    see_from_point(&seen, &job, &triangle, &place, 1);
    choices.resize(4);  // the side of the light and of each corner; what follows is of the triangle's box
  } else {
    see_along(&seen, &job, &triangle, &place, 1);
    choices.erase(choices.begin() + 1, choices.end() - 1);
  }
  LightCellTriangle stored;
  store_triangle(&stored, &seen, 0, point);
  LightCellTable table{};
  for (size_t k = 0; k < 3; ++k) table.grid.toward[k] = input("d" + axes[k]);
  table.grid.top = input("top");
  Real squared;
  const CellRays rays = cell_rays(&table, light, to, gap, point, &squared);
  meets_seen(&stored, &rays, point);
  tests.listed = compared();
  const size_t before = choices.size();
  RayPacket p;
  set_packet(&p, light, to, gap);
  choices.erase(choices.begin() + long(before), choices.end());
  meets_triangle(light, point, &triangle, {p.x, p.y, p.z}, p.end, nullptr);
  tests.traced = compared(before);
  return tests;
}

// One path: the light on either side, each corner as the light, the ray inside.
Recorder::Decide on_side(bool negative) {
  return [negative](const Choice& c) {
    const bool with_zero = recorder.node(c.b).op == 'c' && recorder.node(c.b).value == 0;
    return c.op == '<' ? with_zero && negative : c.op != 'l';
  };
}

// Both compare the same floats, but for the light's side, which the lists compare with a sign.
std::string prove_planes(bool point, const Fault& fault) {
  for (const bool negative : {false, true}) {
    Tests tests;
    const auto kernel = [&] {
      tests = compared_for(point);
      return std::vector<Real>{};
    };
    paths_of(kernel, fault, on_side(negative));
    Compared listed, traced;
    std::ranges::set_difference(tests.listed, tests.traced, std::inserter(listed, listed.end()));
    std::ranges::set_difference(tests.traced, tests.listed, std::inserter(traced, traced.end()));
    if (listed.size() != (negative ? 1 : 0) || traced.size() != (negative ? 1 : 0))
      return "lists compare other floats than the tree";
    if (tests.listed.size() != size_t(point ? 9 : 6)) return "there are more comparisons, or fewer";
    if (!negative) continue;
    const auto [a, op, b] = *listed.begin();
    const auto [a2, op2, b2] = *traced.begin();
    const Node& turned = recorder.node(a);
    if (op != op2 || b != b2 || turned.op != '*' || turned.a != a2 || recorder.node(turned.b).value != -1)
      return "the light's side is another number";
  }
  return "";
}

TEST(CertifyLightCells, ListsTestTheTreesPlanes) {
  EXPECT_EQ(prove_planes(true, {}), "");
  EXPECT_EQ(prove_planes(false, {}), "");
}

// ---- The ray's cell ----

constexpr int lookup_size = 64;

std::vector<Real> lookup_kernel() {
  converted.clear();
  const Real3 to{input("x"), input("y"), input("z")};
  const int cell = cell_of_cube(to, lookup_size);
  const Naming naming;
  for (const Real at : {to.x, to.y, to.z}) give(at, sized("d"));
  for (int i = 0; i < int(recorder.path().nodes.size()); ++i)
    if (recorder.node(i).op == '/') give(of(i), sized("s", u));
  return {converted[0], converted[1], Real(cell)};
}

// The face of the greatest coordinate; each place across it, cut off at the face's ends; and their order in the index.
Meaning meaning_of_lookup() {
  Meaning m{{"x", "y", "z"}, {}};
  m.values = [](const Inputs& in) {
    const long double d[] = {in.at("x"), in.at("y"), in.at("z")};
    size_t along = 0;
    for (size_t k = 1; k < 3; ++k)
      if (std::fabs(d[k]) > std::fabs(d[along])) along = k;
    Values v;
    for (size_t k = 0; k < 3; ++k)
      if (k != along)
        v.push_back(std::clamp((d[k] / std::fabs(d[along]) + 1) * lookup_size / 2, 0.0L, lookup_size - 1.0L));
    v.push_back(int(2 * along + (d[along] < 0)) * (lookup_size * lookup_size + 1) + lookup_size);
    return v;
  };
  m.samples = 2000;
  m.low = -1;
  m.high = 1;
  return m;
}

// A place has an error of at most 4.0001u of half a face: d s is at most that.
std::string prove_lookup(const Fault& fault) {
  const std::vector<Path> paths = paths_of(lookup_kernel, fault);
  for (const Path& path : paths)
    for (const int place : {path.results[0], path.results[1]}) {
      if (path.nodes[size_t(place)].op == 'c') continue;
      const Polynomial error = form_of(path, place).error.with("d*s", Polynomial(lookup_size / 2.0));
      const std::string e = exceeds("a place", error, Polynomial(lookup_error * lookup_size / 2));
      if (!e.empty()) return e;
    }
  return meaning_differs(paths, meaning_of_lookup());
}

TEST(CertifyLightCells, Lookup) { EXPECT_EQ(prove_lookup({}), ""); }

// ---- A plane in a cell ----

LightCellJob job_of_size(int size) {
  LightCellJob job{};
  job.size = uint(size);
  for (size_t k = 0; k < 3; ++k) job.grid.toward[k] = 0;
  job.grid.top = -2.0f;
  job.reach_m = 4.0f;
  return job;
}

Kernel plane_kernel(int size, int number) {
  return [=] {
    recorder.observed = false;
    const LightCellJob job = job_of_size(size);
    CellFace face = cube_face(&job, number);
    recorder.observed = true;
    const Real plane[] = {input("px"), input("py"), input("pz")};
    const CellPlanes greatest = greatest_in_cells(plane, &face);
    const Real value = plane_in_cells(&greatest, input("x"), input("y"));
    const Naming naming;
    for (const char* name : {"px", "py", "pz", "x", "y"}) give(input(name), sized(name));
    const double h = 2.0 / size;
    give(Real(2.0f) / Real(size), Form{h, h * u});
    return std::vector{value};
  };
}

// The greatest value over the cell's corners, for points on the face, and the slack.
Meaning meaning_of_plane(int size, int number, const Fault& fault) {
  Meaning m{{"px", "py", "pz", "x", "y"}, {}};
  m.values = [=](const Inputs& in) {
    const long double p[] = {in.at("px"), in.at("py"), in.at("pz")};
    const size_t along = size_t(number) / 2, across[] = {along == 0 ? 1u : 0u, along == 2 ? 1u : 2u};
    long double greatest = -HUGE_VALL;
    for (const int right : {0, 1})
      for (const int up : {0, 1})
        greatest = std::max(greatest, p[along] * (number % 2 ? -1 : 1) +
                                          p[across[0]] * ((in.at("x") + right) * 2 / size - 1) +
                                          p[across[1]] * ((in.at("y") + up) * 2 / size - 1));
    return Values{greatest + constant_of(double(PLANE_SLACK), fault) *
                                 (std::fabs(p[0]) + std::fabs(p[1]) + std::fabs(p[2]))};
  };
  return m;
}

// If a ray's float side is not negative, neither is the plane's float value in the ray's cell. Relative to the ray's
// greatest coordinate, the side has an error of 3u of each coefficient, and the ray is within 4u of its cell. The value's
// error is added.
std::string prove_plane(const Fault& fault) {
  const Polynomial sum = Polynomial("px") + Polynomial("py") + Polynomial("pz");
  for (int number = 0; number < 6; ++number) {
    for (int size = 8; size <= 96; size += 8) {
      for (const Path& path : paths_of(plane_kernel(size, number), fault)) {
        const Polynomial needed =
            form_of(path, path.results[0]).error.with("x", Polynomial(size)).with("y", Polynomial(size)) +
            sum * Polynomial(side_error + lookup_error);
        const Polynomial slack = sum * Polynomial(constant_of(double(PLANE_SLACK), fault)) + 1e-37;
        if (const std::string e = exceeds("a plane", needed, slack); !e.empty()) return e;
      }
    }
    const bool planted = recorder.planted;
    const std::string e =
        meaning_differs(paths_of(plane_kernel(64, number), fault), meaning_of_plane(64, number, fault));
    recorder.planted |= planted;
    if (!e.empty()) return e;
  }
  return "";
}

// The side of a ray, in units of its coordinates, none of which is greater than the one along its face.
std::string prove_side(const Fault& fault) {
  const auto kernel = [] {
    const Real3 at{input("x"), input("y"), input("z")};
    const Real side = ray_side(at, input("px"), input("py"), input("pz"), 0.0f);
    const Naming naming;
    for (const char* name : {"px", "py", "pz", "x", "y", "z"}) give(input(name), sized(name));
    return std::vector{side};
  };
  const std::vector<Path> paths = paths_of(kernel, fault);
  Polynomial bound;
  for (const std::string& k : axes) bound = bound + Polynomial("p" + k, side_error) * Polynomial(k);
  if (const std::string e = exceeds("a side", form_of(paths[0], paths[0].results[0]).error, bound);
      !e.empty())
    return e;
  Meaning m{{"px", "py", "pz", "x", "y", "z"}, {}};
  m.values = [](const Inputs& in) {
    return Values{in.at("px") * in.at("x") + in.at("py") * in.at("y") + in.at("pz") * in.at("z")};
  };
  return meaning_differs(paths, m);
}

TEST(CertifyLightCells, Side) { EXPECT_EQ(prove_side({}), ""); }
TEST(CertifyLightCells, Plane) { EXPECT_EQ(prove_plane({}), ""); }
TEST(CertifyLightCells, PlaneSlack) {
  EXPECT_THAT(double(least_constant(prove_plane, PLANE_SLACK)) / u,
              testing::AllOf(testing::Gt(10), testing::Lt(30)));
}

// ---- A row of cells ----

std::vector<Real> row_kernel() {
  FaceTriangles t;
  Real inverse[3], first = input("first"), last = input("last");
  for (int e = 0; e < 3; ++e) {
    t.edges[e] = {input("px"), input("py"), input("at")};
    inverse[e] = input("i");
  }
  cells_of_row(&t, inverse, input("y"), &first, &last);
  const Naming naming;
  give(fma(input("y"), input("py"), input("at")), sized("row"));
  give(input("i"), sized("i", u));
  const auto under = [](Real x, char op) {
    return recorder.node(x.id).op == op ? of(recorder.node(x.id).a) : Real(0);
  };
  return {under(under(under(first, 'n'), 'f'), 'n'), under(last, 'f')};
}

// The first cell before it is rounded up, and the last before it is rounded down.
Meaning meaning_of_row(const Fault& fault) {
  Meaning m{{"px", "py", "at", "y", "i", "first", "last"}, {}};
  m.adjust = [](Inputs& in) {
    in["i"] = 1 / std::fabs(in["px"]);
    return true;
  };
  m.values = [slack = constant_of(double(ROW_SLACK), fault)](const Inputs& in) {
    // px x + row >= 0 from here on, or up to here.
    const long double zero = -(in.at("y") * in.at("py") + in.at("at")) / in.at("px");
    const bool rises = in.at("px") >= 0;
    return Values{rises ? std::max(zero - slack, in.at("first")) : in.at("first"),
                  rises ? in.at("last") : std::min(zero + slack, in.at("last"))};
  };
  m.low = -20;
  m.high = 20;
  return m;
}

// Where the line of an edge leaves a row has an error of less than ROW_SLACK, within the face and one cell around it.
std::string prove_row(const Fault& fault) {
  const std::vector<Path> paths = paths_of(row_kernel, fault);
  for (const Path& path : paths)
    for (const Choice& c : path.choices) {
      if (path.nodes[size_t(c.a)].op == 'i') continue;
      const Polynomial error = form_of(path, c.a).error.with("i*row", Polynomial(97.0));
      const std::string e = exceeds("a row's end", error, Polynomial(constant_of(double(ROW_SLACK), fault)));
      if (!e.empty()) return e;
    }
  return meaning_differs(paths, meaning_of_row(fault));
}

TEST(CertifyLightCells, Row) { EXPECT_EQ(prove_row({}), ""); }
TEST(CertifyLightCells, RowSlack) {
  EXPECT_THAT(double(least_constant(prove_row, ROW_SLACK)),
              testing::AllOf(testing::Gt(1e-5), testing::Lt(3e-5)));
}

// ---- The nearest ray of a cell ----

constexpr float near_factor = 0.999f;

Kernel near_kernel(int size) {
  return [size] {
    CellFace face{};
    face.size = size;
    face.height = 0.0f;
    face.cosine = -2.0f;
    const Real offset = input("offset"), rising = input("rising"), box = input("box");
    const Real near = near_in_cells(&face, input("x"), input("y"), offset, rising, box);
    const Naming naming;
    const Real h = Real(2.0f) / Real(size);
    const double exact = 2.0 / size;
    give(h, Form{exact, exact * u});
    give(Real(0.5f) * h, Form{exact / 2, exact / 2 * u});
    give(Real(0.5f) * h - Real(1.0f), Form{1, 2 * u});
    for (const char* name : {"x", "y"}) give(input(name), Form{double(size), {}});
    return std::vector{near};
  };
}

Meaning meaning_of_near(int size, const Fault& fault) {
  Meaning m{{"x", "y", "offset", "rising", "box"}, {}};
  m.low = 0;
  m.high = size - 1;
  m.values = [=](const Inputs& in) {
    const auto least = [&](const char* axis) {
      const long double low = in.at(axis) * 2 / size - 1;
      return std::max({low, -low - 2.0L / size, 0.0L});
    };
    const long double shortest = std::hypot(std::hypot(least("x"), least("y")), 1.0L);
    return Values{
        std::max(-in.at("offset") * constant_of(double(near_factor), fault) * shortest / in.at("rising"),
                 in.at("box"))};
  };
  m.adjust = [](Inputs& in) {
    in["offset"] = -in["offset"];
    in["box"] /= 8;
    return true;
  };
  return m;
}

// A ray is at least as long as its plane's distance over its cosine. Its float length is within 4u of itself, it is
// within 4u of its cell, and the least coordinates in the cell have an error: the length of (u, v, 1) changes by at most
// sqrt(2) times that, and is at least 1.
std::string prove_near(const Fault& fault) {
  for (const int size : {8, 24, 96}) {
    for (const Path& path : paths_of(near_kernel(size), fault)) {
      std::map<int, double> given;
      double away = 0;
      for (int i = 0; i < int(path.nodes.size()); ++i) {
        const Node& n = path.nodes[size_t(i)];
        if (n.op != '-' || path.nodes[size_t(n.a)].op != 'a') continue;
        given[i] = 0;  // at least 0 where it is used
        away = std::max(away, form_of(path, i).error[""]);
      }
      if (away == 0) return "a cell has no place on its face";
      double error = 0;
      for (int i = 0; i < int(path.nodes.size()); ++i)
        if (path.nodes[size_t(i)].op == '/' && path.nodes[size_t(path.nodes[size_t(i)].b)].name == "rising")
          error = relative_error(path, i, given);
      const double sum = error + std::sqrt(2.0) * (away + lookup_error) + 4 * u;
      if (const std::string e = exceeds("a distance", sum, 1 - constant_of(double(near_factor), fault));
          !e.empty())
        return e;
    }
    if (size != 8) continue;
    const bool planted = recorder.planted;
    const std::string e = meaning_differs(paths_of(near_kernel(size), fault), meaning_of_near(size, fault));
    recorder.planted |= planted;
    if (!e.empty()) return e;
  }
  return "";
}

TEST(CertifyLightCells, Near) {
  EXPECT_EQ(prove_near({}), "");
  EXPECT_EQ(prove_near({.constant = near_factor, .instead = 1 - 50 * u}), "");
  EXPECT_NE(prove_near({.constant = near_factor, .instead = 1 - 10 * u}), "");
}

// ---- A cell of a small triangle ----

volatile uint counts[6 * (8 * 8 + 1) + 1];

// add_small looks at one cell: its edges' rows by cells_of_row, its plane by plane_in_cells, its distance by near_in_cells.
std::string prove_small(const Fault& fault) {
  std::string wrong = "no cell is counted";
  const auto kernel = [&] {
    converted.clear();
    std::fill(std::begin(counts), std::end(counts), 0u);
    const LightCellJob job = job_of_size(8);
    recorder.observed = false;
    CellFace face = cube_face(&job, 3);
    recorder.observed = true;
    face.reach = input("reach");
    face.height = 0.0f;  // which C's initializers set
    FaceTriangles t;
    for (int i = 0; i < 4; ++i) {
      const std::string n = std::to_string(i);
      CellPlanes& plane = i < 3 ? t.edges[i] : t.plane;
      plane.x = input("x" + n);
      plane.y = input("y" + n);
      plane.at = input("at" + n);
    }
    t.first_x = input("first_x");
    t.last_x = input("last_x");
    t.first_y = input("first_y");
    t.last_y = input("last_y");
    SeenTriangles s{};
    s.offset = input("offset");
    s.near = input("near");
    LightCellItems items{counts, nullptr, 0};
    add_small(&face, &s, &t, 1, 0, &items);
    std::vector<Choice>& choices = recorder.path().choices;
    const size_t made = choices.size();
    const Naming naming;
    const Real y = t.first_y;
    Real first = t.first_x, last = t.last_x, inverse[3];
    for (int e = 0; e < 3; ++e) inverse[e] = Real(1.0f) / fabs(t.edges[e].x);
    cells_of_row(&t, inverse, y, &first, &last);
    const Real rising = plane_in_cells(&t.plane, first, y),
               near = near_in_cells(&face, first, y, s.offset, rising, s.near);
    const std::vector<Choice> expected(choices.begin() + long(made), choices.end());
    choices.resize(made);
    const auto has = [&](Real a, char op, Real b) {
      return std::ranges::any_of(choices,
                                 [&](const Choice& c) { return c.a == a.id && c.op == op && c.b == b.id; });
    };
    if (!std::ranges::all_of(expected, [&](const Choice& c) { return has(of(c.a), c.op, of(c.b)); }))
      wrong = "other comparisons";
    else if (!has(y, 'l', t.last_y) || !has(first, 'l', last))
      wrong = "another range of cells";
    else if (!has(y + Real(1.0f), 'l', t.last_y) || !has(first + Real(1.0f), 'l', last))
      wrong = "another next cell";
    else if (!has(rising, 'g', 0.0f))
      wrong = "another plane";
    else if (!has(near, 'l', face.reach))
      wrong = "another distance";
    else if (converted.size() != 2)
      wrong = "a cell has two coordinates";
    else {
      const int row = converted[0].id == y.id ? 0 : 1, column = 1 - row;
      const bool right = converted[size_t(row)].id == y.id && converted[size_t(column)].id == first.id;
      wrong = right && counts[3 * 65 + row * 8 + column + 1] == 1 ? "" : "another cell is counted";
    }
    return std::vector{near};
  };
  // The first cell of the first row, and no other.
  paths_of(kernel, fault, [](const Choice& c) -> std::optional<bool> {
    const Node &a = recorder.node(c.a), &b = recorder.node(c.b);
    if (c.op == 'l' && (b.name == "last_y" || b.op == 'f')) return a.op != '+';
    return c.op != '<' && c.op != '>';
  });
  return wrong;
}

TEST(CertifyLightCells, SmallTriangles) { EXPECT_EQ(prove_small({}), ""); }

TEST(CertifyLightCells, Faults) {
  const Proof proofs[] = {[](const Fault& f) { return prove_planes(true, f); },
                          [](const Fault& f) { return prove_planes(false, f); },
                          prove_lookup,
                          prove_plane,
                          prove_side,
                          prove_row,
                          prove_near,
                          prove_small};
  for (const Proof& proof : proofs) {
    const Faults f = planted_faults(proof);

    EXPECT_GE(f.planted, 10);
    EXPECT_THAT(f.survived, testing::IsEmpty());
  }
}

}  // namespace
}  // namespace lightgrid::certify
