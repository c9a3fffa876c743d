#pragma once

#include "testbed/topic.h"

namespace geoprior::toy {

/// "toy-pendulum": processes. A damped pendulum at small angles, theta'' + 2 g theta' + w^2 theta
/// = 0, released at rest: theta(t) = theta_0 exp(-g t) (cos(w_d t) + g / w_d sin(w_d t)), w_d^2 =
/// w^2 - g^2.
///
/// Methods "implicit-midpoint" (second order), "closed-form" and the baseline "explicit-euler"
/// (first order). Each pushes the parts "rod" (lines), "bob" (points) and "warmth" (a grid), an
/// event at every crossing of the vertical, the artifact swing.wav at the end, and a checkpoint
/// after every frame.
Topic pendulum_topic();

/// "toy-circle": pose methods. The disc seen from the centre, turned by an angle in degrees:
/// "exact", and the baseline "polygon", which replaces the rim by a regular polygon of `segments`
/// corners (radius error at most r (1 - cos(pi / segments)), second order in 1 / segments).
Topic circle_topic();

/// theta(t) of the closed form above (rad).
double pendulum_angle(double initial_angle, double frequency, double damping, double time_s);

/// Both of them.
std::vector<Topic> topics();

}  // namespace geoprior::toy
