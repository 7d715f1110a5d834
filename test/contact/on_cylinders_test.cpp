// Cylinders: their contacts are those of the cylinder, however its mesh is turned.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "blem_sim/geometry/cylinder.h"
#include "contact/contact_shapes.h"
#include "features/mesh_pair.h"

namespace blem_sim::contact {
namespace {

constexpr double WHEEL = 0.05, HALF_WIDTH = 0.02, WHEEL_LAYER = 0.0025;  // [m]

/** A wheel about its z axis, on a body. */
Collider wheel() {
  Collider collider;
  const auto mesh = std::make_shared<const geometry::TriangleMesh>(geometry::cylinderMesh(WHEEL, 2 * HALF_WIDTH));
  collider.geometry = std::make_shared<const CollisionGeometry>(mesh, nullptr, geometry::cylinderBehind(*mesh));
  collider.radius = WHEEL_LAYER;
  collider.body = 0;
  return collider;
}

/** A wheel whose axis leans by an angle off the level, turned about its axis, its middle at a height. */
Pose rolled(double height, double lean, double turn, double heading = 0.3) {
  const Matrix3 R = (Eigen::AngleAxisd(heading, Vector3::UnitZ()) * Eigen::AngleAxisd(-M_PI / 2 + lean, Vector3::UnitX()) *
                     Eigen::AngleAxisd(turn, Vector3::UnitZ()))
                        .toRotationMatrix();
  Pose X = Pose::Identity();
  X.linear() = R;
  X.translation() = Vector3(0.013, -0.007, height);
  return X;
}

/** [m] Height of a rim's lowest point. */
double lowestOfRim(const Pose& X_WK, bool is_upper) {
  const Vector3 axis = X_WK.linear().col(2);
  return X_WK.translation().z() + (is_upper ? 1 : -1) * HALF_WIDTH * axis.z() - WHEEL * std::hypot(axis.x(), axis.y());
}

TEST(CylinderBehindAMesh, IsFoundWhereItWasMoved) {
  const Pose X = makePose({1, 2, 3}, {0.3, 0.2, 0.1});
  const geometry::TriangleMesh mesh = geometry::transformed(geometry::cylinderMesh(0.3, 0.8), X);
  const auto found = geometry::cylinderBehind(mesh);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->radius, 0.3, 1e-12);
  EXPECT_NEAR(found->half_length, 0.4, 1e-12);
  EXPECT_NEAR((found->X_GK.matrix() - X.matrix()).norm(), 0, 1e-9);
  geometry::TriangleMesh dented = mesh;
  dented.vertices[7].x() += 1e-6;
  EXPECT_FALSE(geometry::cylinderBehind(dented));
  EXPECT_FALSE(geometry::cylinderBehind(geometry::boxMesh(Vector3::Ones())));
}

TEST(OnCylinders, LowestPointsOfTheRimsTouchAPlaneHoweverTheMeshIsTurned) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI), lean(-1.2, 1.2);
  const Collider ground = makeHalfSpace(Vector3::UnitZ(), 0), tiles = makeCollider(geometry::gridMesh(2, 2, 7, 5), 0), round = wheel();
  for (int i = 0; i < 200; ++i) {
    const Pose X = rolled(WHEEL, i < 100 ? 0 : lean(random), angle(random));
    const double lower = std::min(lowestOfRim(X, false), lowestOfRim(X, true));
    Pose touching = X;
    touching.translation().z() += WHEEL_LAYER - lower - 1e-4;  // 0.1 mm deep
    for (const Collider* below : {&ground, &tiles}) {
      const ContactManifold manifold = contactsOf(round, touching, *below, Pose::Identity());
      EXPECT_NEAR(manifold.maxDepth(), 1e-4, 1e-12);
      int touch = 0;
      for (const Contact& contact : manifold.contacts) {
        EXPECT_NEAR((contact.normal_BA - Vector3::UnitZ()).norm(), 0, 1e-9);
        if (contact.depth < 0) continue;
        ++touch;
        const bool is_upper = (touching.inverse() * contact.point).z() > 0;
        EXPECT_NEAR(contact.depth, WHEEL_LAYER - lowestOfRim(touching, is_upper), 1e-12);
        EXPECT_EQ(rimRadius(round, contact.id, true), WHEEL);
        const Vector3 axis = touching.linear().col(2), arm = contact.point - touching.translation();
        EXPECT_NEAR(axis.cross(Vector3::UnitZ()).dot(arm), 0, 1e-12);  // straight below the axis
      }
      EXPECT_EQ(touch, i < 100 ? 2 : 1);
    }
  }
}

TEST(OnCylinders, ContactsKeepTheirNamesWhileTheWheelRolls) {
  const Collider ground = makeHalfSpace(Vector3::UnitZ(), 0), round = wheel();
  std::set<std::uint64_t> names;
  for (int i = 0; i < 500; ++i)
    for (const Contact& contact : contactsOf(round, rolled(WHEEL + 0.9 * WHEEL_LAYER, 0, 0.013 * i), ground, Pose::Identity()).contacts)
      names.insert(contact.id);
  EXPECT_EQ(names.size(), 2u);
}

TEST(OnCylinders, AFlatEndStandsOnAllOfItsRim) {
  const Collider ground = makeHalfSpace(Vector3::UnitZ(), 0);
  Pose standing = Pose::Identity();
  standing.translation().z() = HALF_WIDTH + 0.9 * WHEEL_LAYER;
  EXPECT_EQ(contactsOf(wheel(), standing, ground, Pose::Identity()).contacts.size(), 64u);
}

TEST(OnCylinders, BallsMeetMantleAndRim) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  const Collider ball = makeCollider(geometry::pointMesh(Vector3::Zero()), 0.01), round = wheel();
  for (int i = 0; i < 200; ++i) {
    const Pose X = rolled(0, 0.4, angle(random));
    const double around = angle(random), beyond = i % 2 == 0 ? 0 : 0.005, out = i % 2 == 0 ? 0.0124 : 0.01;
    const Vector3 p((WHEEL + out) * std::cos(around), (WHEEL + out) * std::sin(around), i % 2 == 0 ? 0.011 : HALF_WIDTH + beyond);
    const ContactManifold manifold = contactsOf(round, X, ball, makePose(X * p));
    ASSERT_EQ(manifold.contacts.size(), 1u);
    EXPECT_NEAR(manifold.contacts[0].depth, WHEEL_LAYER + 0.01 - std::hypot(out, beyond), 1e-12);
    const Vector3 inwards = X.linear().transpose() * manifold.contacts[0].normal_BA;
    EXPECT_NEAR(inwards.head<2>().dot(p.head<2>().normalized()), -out / std::hypot(out, beyond), 1e-9);
  }
}

/** [m] Distance of a solid wheel from the y axis: a convex function along it. */
double distanceFromEdge(const Pose& X_WK) {
  const Pose X_KW = X_WK.inverse();
  const auto distance = [&](double y) {
    const Vector3 q = X_KW * Vector3(0, y, 0);
    return std::hypot(std::max(0.0, std::abs(q.z()) - HALF_WIDTH), std::max(0.0, q.head<2>().norm() - WHEEL));
  };
  double lower = -0.2, upper = 0.2;
  for (int i = 0; i < 100; ++i) {
    const double left = lower + (upper - lower) / 3, right = upper - (upper - lower) / 3;
    (distance(left) < distance(right) ? upper : lower) = distance(left) < distance(right) ? right : left;
  }
  return distance(0.5 * (lower + upper));
}

TEST(OnCylinders, MantleAndRimsMeetAKerb) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  const Collider kerb = makeCollider(geometry::boxMesh({1, 1, 1}), 0), round = wheel();
  const Pose X_WKerb = makePose({-0.5, 0, -0.5});  // its upper edge is the y axis
  for (const double askew : {0.0, 1e-4, 0.2, 0.7, 1.3}) {
    for (int i = 0; i < 100; ++i) {
      Pose X = Pose::Identity();
      X.linear() = (Eigen::AngleAxisd(askew, Vector3::UnitZ()) * Eigen::AngleAxisd(M_PI / 2, Vector3::UnitX()) *
                    Eigen::AngleAxisd(angle(random), Vector3::UnitZ()))
                       .toRotationMatrix();
      X.translation() = Vector3(0.03, 0.02, 0.2);
      while (distanceFromEdge(X) > 1e-3) X.translation().z() -= 0.5 * (distanceFromEdge(X) - 0.9e-3);
      const ContactManifold manifold = contactsOf(round, X, kerb, X_WKerb);
      EXPECT_NEAR(WHEEL_LAYER - manifold.maxDepth(), distanceFromEdge(X), 1e-8) << askew << " " << i;
    }
  }
}

/** The rim's lowest point is over a sheet, or beyond its border, however far beside it the vertices of the mesh are. */
TEST(OnCylinders, RimsMeetTheBorderOfASheetWhereTheyLeaveIt) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI), beyond(-0.004, 0.004);
  const Collider round = wheel(), sheet = makeCollider(geometry::transformed(geometry::gridMesh(1, 1, 3, 1), makePose({0.5, 0, 0})), 0);
  for (const double lean : {0.2, 0.8})
    for (int i = 0; i < 400; ++i) {
      Pose X = rolled(0.2, lean, angle(random), angle(random));
      const bool is_upper = X.linear()(2, 2) < 0;
      const Vector3 axis = X.linear().col(2), down = (axis.z() * axis - Vector3::UnitZ()).normalized();
      const Vector3 lowest = (is_upper ? HALF_WIDTH : -HALF_WIDTH) * axis + WHEEL * down;
      const double x = beyond(random);
      X.translation().x() = x - lowest.x();
      double distance = INFINITY;
      for (int k = 0; k < 100; ++k) {
        distance = x >= 0 ? lowestOfRim(X, is_upper) : distanceFromEdge(X);
        X.translation().z() -= distance - 1e-3;
      }
      const ContactManifold manifold = contactsOf(round, X, sheet, Pose::Identity());
      EXPECT_NEAR(WHEEL_LAYER - manifold.maxDepth(), 1e-3, 1e-8) << lean << " " << i << " " << x;
    }
}

/** A wheel that rolls over the edge of a kerb, level and square to it. */
TEST(OnCylinders, BothRimsMeetAnEdgeAlike) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI), beside(-0.003, 0.002);
  const Collider kerb = makeCollider(geometry::boxMesh({1, 1, 1}), 0), round = wheel();
  const Pose X_WKerb = makePose({-0.5, 0, -0.5});  // its upper edge is the y axis
  for (int i = 0; i < 300; ++i) {
    Pose X = rolled(WHEEL + 1e-3, 0, angle(random), 0);
    X.translation().x() = beside(random);
    const ContactManifold manifold = contactsOf(round, X, kerb, X_WKerb);
    double deepest[2] = {-1, -1};
    for (const Contact& contact : manifold.contacts) {
      double& of_rim = deepest[(X.inverse() * contact.point).z() > 0];
      of_rim = std::max(of_rim, contact.depth);
    }
    const double distance = std::hypot(std::max(0.0, X.translation().x()), X.translation().z()) - WHEEL;
    for (const double depth : deepest) EXPECT_NEAR(depth, WHEEL_LAYER - distance, 1e-9) << i;
  }
}

/** A trough along y of a radius, whose bottom is the origin, of facets between which it turns by an angle. */
geometry::TriangleMesh troughMesh(double radius, double turn) {
  const int half = static_cast<int>(0.4 / turn);
  geometry::TriangleMesh mesh = geometry::gridMesh(2 * half, 1, 2 * half, 1);
  for (Vector3& v : mesh.vertices) v = Vector3(radius * std::sin(turn * v.x()), v.y(), radius - radius * std::cos(turn * v.x()));
  return mesh;
}

/** Lowest point of a rim over one facet of a trough. */
struct LowestPlace {
  Vector3 normal;   // of the facet
  double distance;  // [m]
};

/** Lowest points of a wheel's rims over those facets of a trough that they are over. */
std::vector<LowestPlace> lowestPlaces(const Pose& X_WK, double radius, double turn) {
  std::vector<LowestPlace> places;
  const Vector3 axis = X_WK.linear().col(2);
  const int half = static_cast<int>(0.4 / turn);
  for (int i = -half; i < half; ++i)
    for (const bool is_upper : {false, true}) {
      const double slope = turn * (i + 0.5), chord = radius * std::sin(0.5 * turn);
      const Vector3 normal(-std::sin(slope), 0, std::cos(slope)), along(std::cos(slope), 0, std::sin(slope));
      const Vector3 lowest = X_WK.translation() + (is_upper ? HALF_WIDTH : -HALF_WIDTH) * axis +
                             WHEEL * (normal.dot(axis) * axis - normal).normalized() - Vector3(0, 0, radius);
      if (std::abs(along.dot(lowest)) <= chord) places.push_back({normal, radius * std::cos(0.5 * turn) + normal.dot(lowest)});
    }
  return places;
}

/** Facets narrower and wider than a side of the wheel's mesh, which turn by less than a side does. */
TEST(OnCylinders, RimsMeetAllFacetsOfATrough) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI), part(-0.2, 0.2), x(-0.05, 0.05);
  for (const auto& [radius, turn] : {std::pair{0.5, 0.002}, {0.5, 0.02}, {2.0, 0.02}, {0.3, 0.08}}) {
    const Collider round = wheel(), trough = makeCollider(troughMesh(radius, turn), 0);
    for (int i = 0; i < 300; ++i) {
      Pose X = rolled(WHEEL, i % 2 == 0 ? 0 : part(random), angle(random), i % 3 == 0 ? 0 : part(random));
      X.translation().x() = x(random);
      std::vector<LowestPlace> places;
      for (int k = 0; k < 30; ++k) {  // the nearest place is 1 mm away
        places = lowestPlaces(X, radius, turn);
        double least = INFINITY;
        for (const LowestPlace& place : places) least = std::min(least, place.distance);
        X.translation().z() += 1e-3 - least;
      }
      const ContactManifold manifold = contactsOf(round, X, trough, Pose::Identity(), 1e-3);
      EXPECT_NEAR(WHEEL_LAYER - manifold.maxDepth(), 1e-3, 1e-8) << radius << " " << turn << " " << i;
      for (const LowestPlace& place : places) {
        if (place.distance > 1.2e-3) continue;
        EXPECT_TRUE(std::any_of(manifold.contacts.begin(), manifold.contacts.end(),
                                [&](const Contact& c) {
                                  return std::abs(WHEEL_LAYER - c.depth - place.distance) < 1e-8 &&
                                         (c.normal_BA - place.normal).norm() < 1e-8;
                                }))
            << radius << " " << turn << " " << i << " " << place.distance;
      }
    }
  }
}

/** Parallel wheels, one of them shifted along its axis, and crossed ones. */
TEST(OnCylinders, CylindersMeetCylinders) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  Collider first = wheel(), second = wheel();
  const auto turned = [&](const Vector3& p, const Matrix3& R) {
    Pose X = Pose::Identity();
    X.linear() = R * Eigen::AngleAxisd(angle(random), Vector3::UnitZ()).toRotationMatrix();
    X.translation() = p;
    return X;
  };
  for (int i = 0; i < 300; ++i) {
    first.body = i < 100 ? -1 : 0;
    second.body = i < 200 ? 1 : -1;
    const double around = angle(random), distance = 2 * WHEEL + 1.5 * WHEEL_LAYER;
    const Vector3 beside(distance * std::cos(around), distance * std::sin(around), 0.6 * HALF_WIDTH);
    const Matrix3 R = Eigen::Quaterniond(0.5, 0.1 * i, 0.3, -0.2).normalized().toRotationMatrix();
    const ContactManifold parallel = contactsOf(first, turned(Vector3::Zero(), R), second, turned(R * beside, R));
    ASSERT_EQ(parallel.contacts.size(), 2u) << i;
    for (const Contact& contact : parallel.contacts) {
      EXPECT_NEAR(contact.depth, 0.5 * WHEEL_LAYER, 1e-12);
      EXPECT_NEAR((R.transpose() * contact.normal_BA).dot(Vector3(std::cos(around), std::sin(around), 0)), -1, 1e-12);
    }
    const Matrix3 crossed = R * Eigen::AngleAxisd(0.9, Vector3::UnitX()).toRotationMatrix();
    const ContactManifold cross = contactsOf(first, turned(Vector3::Zero(), R), second, turned(R * Vector3(distance, 0, 0), crossed));
    ASSERT_EQ(cross.contacts.size(), 1u) << i;
    EXPECT_NEAR(cross.contacts[0].depth, 0.5 * WHEEL_LAYER, 1e-12);
  }
}

}  // namespace
}  // namespace blem_sim::contact
