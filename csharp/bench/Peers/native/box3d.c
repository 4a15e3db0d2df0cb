#include "peer.h"
#include "box3d/box3d.h"
#include <stdlib.h>

typedef struct
{
	b3WorldId id;
	b3BodyId ground;
	b3BodyId* bodies;
	int count;
	int substeps;
	double frequency;
} World;

static b3Vec3 vec(const double* v) { return (b3Vec3){v[0], v[1], v[2]}; }

static b3Quat quat(const double* q) { return (b3Quat){{q[0], q[1], q[2]}, q[3]}; }

// Box3D's hinges turn about Z: first Z is put where X was.
static b3Transform about_z(const double* frame)
{
	const float h = 0.70710678f;
	return (b3Transform){vec(frame), b3MulQuat(quat(frame + 3), (b3Quat){{0, h, 0}, h})};
}

void* peer_create(int substeps, double frequency, const double* gravity)
{
	World* w = calloc(1, sizeof(World));
	b3WorldDef def = b3DefaultWorldDef();
	def.gravity = vec(gravity);
	def.enableSleep = false;
	def.enableContinuous = false;
	def.workerCount = 1;
	w->id = b3CreateWorld(&def);
	w->substeps = substeps;
	w->frequency = frequency;
	b3BodyDef ground = b3DefaultBodyDef();
	w->ground = b3CreateBody(w->id, &ground);
	return w;
}

void peer_body(void* world, const double* pose, double mass, const double* inertia, const double* velocity)
{
	World* w = world;
	b3BodyDef def = b3DefaultBodyDef();
	def.type = b3_dynamicBody;
	def.position = vec(pose);
	def.rotation = quat(pose + 3);
	def.linearVelocity = vec(velocity);
	def.angularVelocity = vec(velocity + 3);
	def.enableSleep = false;
	def.allowFastRotation = true;
	w->bodies = realloc(w->bodies, (w->count + 1) * sizeof(b3BodyId));
	b3BodyId body = b3CreateBody(w->id, &def);
	w->bodies[w->count++] = body;
	b3MassData data = {0};
	data.mass = mass;
	data.inertia.cx.x = inertia[0];
	data.inertia.cy.y = inertia[1];
	data.inertia.cz.z = inertia[2];
	b3Body_SetMassData(body, data);
}

void peer_hinge(void* world, int body0, int body1, const double* frame, const double* frame0, const double* frame1, int is_driven, double speed, double limit)
{
	(void)frame;
	World* w = world;
	b3RevoluteJointDef def = b3DefaultRevoluteJointDef();
	def.base.bodyIdA = body0 < 0 ? w->ground : w->bodies[body0];
	def.base.bodyIdB = body1 < 0 ? w->ground : w->bodies[body1];
	def.base.localFrameA = about_z(frame0);
	def.base.localFrameB = about_z(frame1);
	if (w->frequency > 0)
		def.base.constraintHertz = w->frequency;
	if (is_driven)
	{
		def.enableMotor = true;
		def.motorSpeed = (float)speed;
		def.maxMotorTorque = (float)limit;
	}
	b3CreateRevoluteJoint(w->id, &def);
}

void peer_step(void* world, double dt)
{
	World* w = world;
	b3World_Step(w->id, (float)dt, w->substeps);
}

void peer_read(void* world, int body, double* state)
{
	World* w = world;
	b3WorldTransform t = b3Body_GetTransform(w->bodies[body]);
	b3Vec3 v = b3Body_GetLinearVelocity(w->bodies[body]);
	b3Vec3 a = b3Body_GetAngularVelocity(w->bodies[body]);
	double values[13] = {t.p.x, t.p.y, t.p.z, t.q.v.x, t.q.v.y, t.q.v.z, t.q.s, v.x, v.y, v.z, a.x, a.y, a.z};
	for (int i = 0; i < 13; i++)
		state[i] = values[i];
}

void peer_destroy(void* world)
{
	World* w = world;
	b3DestroyWorld(w->id);
	free(w->bodies);
	free(w);
}
