// An engine behind the benchmarks: hinges and sliders between bodies and the world, no contacts, no damping, no sleep, one thread.
// A pose is x y z, then qx qy qz qw.
#pragma once

void* peer_create(int substeps, double frequency, const double* gravity);
// The pose is that of the centre of mass and the principal axes; velocity is linear, then angular, in the world.
void peer_body(void* world, const double* pose, double mass, const double* inertia, const double* velocity);
// About X of a world frame, which is also given in each body; -1 is the world. A driven one has the engine's own motor hold the speed of body 1
// against body 0 within a torque.
void peer_hinge(void* world, int body0, int body1, const double* frame, const double* frame0, const double* frame1, int is_driven, double speed, double limit);
// Along X of a world frame; ODE alone has it here.
void peer_slider(void* world, int body0, int body1, const double* frame);
void peer_step(void* world, double dt);
// Pose, linear and angular velocity: 13 numbers.
void peer_read(void* world, int body, double* state);
void peer_destroy(void* world);
