#include "peer.h"
#include <ode/ode.h>
#include <stdlib.h>

typedef struct
{
	dWorldID id;
	dBodyID* bodies;
	int count;
	int substeps;
} World;

void* peer_create(int substeps, double frequency, const double* gravity)
{
	(void)frequency;
	static int started = 0;
	if (!started++)
		dInitODE2(0);
	World* w = calloc(1, sizeof(World));
	w->id = dWorldCreate();
	w->substeps = substeps;
	dWorldSetGravity(w->id, gravity[0], gravity[1], gravity[2]);
	return w;
}

void peer_body(void* world, const double* pose, double mass, const double* inertia, const double* velocity)
{
	World* w = world;
	dBodyID body = dBodyCreate(w->id);
	dMass m;
	dMassSetParameters(&m, mass, 0, 0, 0, inertia[0], inertia[1], inertia[2], 0, 0, 0);
	dBodySetMass(body, &m);
	dBodySetPosition(body, pose[0], pose[1], pose[2]);
	dQuaternion q = {pose[6], pose[3], pose[4], pose[5]};
	dBodySetQuaternion(body, q);
	dBodySetLinearVel(body, velocity[0], velocity[1], velocity[2]);
	dBodySetAngularVel(body, velocity[3], velocity[4], velocity[5]);
	w->bodies = realloc(w->bodies, (w->count + 1) * sizeof(dBodyID));
	w->bodies[w->count++] = body;
}

static void axis_x(const double* frame, double* axis)
{
	double x = frame[3], y = frame[4], z = frame[5], s = frame[6];
	axis[0] = 1 - 2 * (y * y + z * z);
	axis[1] = 2 * (x * y + s * z);
	axis[2] = 2 * (x * z - s * y);
}

static dBodyID body_at(const World* w, int body) { return body < 0 ? 0 : w->bodies[body]; }

void peer_hinge(void* world, int body0, int body1, const double* frame, const double* frame0, const double* frame1, int is_driven, double speed, double limit)
{
	(void)frame0;
	(void)frame1;
	World* w = world;
	dJointID joint = dJointCreateHinge(w->id, 0);
	dJointAttach(joint, body_at(w, body0), body_at(w, body1));
	dJointSetHingeAnchor(joint, frame[0], frame[1], frame[2]);
	double x[3];
	axis_x(frame, x);
	dJointSetHingeAxis(joint, x[0], x[1], x[2]);
	if (is_driven)
	{
		// ODE's speed is that of the first body against the second, and a world in the first place changes places with the second.
		dJointSetHingeParam(joint, dParamVel, body0 < 0 ? speed : -speed);
		dJointSetHingeParam(joint, dParamFMax, limit);
	}
}

void peer_slider(void* world, int body0, int body1, const double* frame)
{
	World* w = world;
	dJointID joint = dJointCreateSlider(w->id, 0);
	dJointAttach(joint, body_at(w, body0), body_at(w, body1));
	double x[3];
	axis_x(frame, x);
	dJointSetSliderAxis(joint, x[0], x[1], x[2]);
}

void peer_step(void* world, double dt)
{
	World* w = world;
	for (int i = 0; i < w->substeps; i++)
		dWorldStep(w->id, dt / w->substeps);
}

void peer_read(void* world, int body, double* state)
{
	World* w = world;
	const dReal* p = dBodyGetPosition(w->bodies[body]);
	const dReal* q = dBodyGetQuaternion(w->bodies[body]);
	const dReal* v = dBodyGetLinearVel(w->bodies[body]);
	const dReal* a = dBodyGetAngularVel(w->bodies[body]);
	double values[13] = {p[0], p[1], p[2], q[1], q[2], q[3], q[0], v[0], v[1], v[2], a[0], a[1], a[2]};
	for (int i = 0; i < 13; i++)
		state[i] = values[i];
}

void peer_destroy(void* world)
{
	World* w = world;
	dWorldDestroy(w->id);
	free(w->bodies);
	free(w);
}
