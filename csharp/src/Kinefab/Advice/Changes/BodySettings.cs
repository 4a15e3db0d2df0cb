using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Advice.Changes;

/// <summary>Changes of masses and inertias: the mechanism then moves a little otherwise, which the trial's deviation shows.</summary>
internal static class BodySettings
{
    /// <summary>Masses of two jointed bodies further apart than this are called unlike.</summary>
    public const double MostRatio = 10;

    // Moments below this share of the body's largest are raised to the second.
    private const double ThinShare = 0.1;
    private const double FullShare = 0.3;

    // Radians that the weight may turn a body by in one step.
    private const double WeightTurn = 0.25;

    /// <summary>Joints between unlike masses, worst first: ratio, lighter and heavier body.</summary>
    public static IEnumerable<(WorldJoint Joint, double Ratio, WorldBody Light, WorldBody Heavy)> UnlikeMasses(World world)
    {
        foreach (WorldJoint joint in world.Joints)
        {
            // Reduced coordinates take any ratio along a tree.
            if (joint is WorldLinkJoint || joint.Solved.Body0 < 0 || joint.Solved.Body1 < 0)
                continue;
            WorldBody a = world.Bodies[joint.Solved.Body0];
            WorldBody b = world.Bodies[joint.Solved.Body1];
            if (a.IsKinematic || b.IsKinematic)
                continue;
            (WorldBody light, WorldBody heavy) = a.Settings.Mass < b.Settings.Mass ? (a, b) : (b, a);
            double ratio = heavy.Settings.Mass / light.Settings.Mass;
            if (ratio > MostRatio)
                yield return (joint, ratio, light, heavy);
        }
    }

    /// <summary>The lighter of two unlike bodies gets a tenth of the heavier one's mass, and its inertia in proportion.</summary>
    public static Change? RaiseMasses(ValidScene scene, World world)
    {
        var masses = new Dictionary<WorldBody, double>();
        foreach ((_, _, WorldBody light, WorldBody heavy) in UnlikeMasses(world))
            masses[light] = Math.Max(heavy.Settings.Mass / MostRatio, masses.TryGetValue(light, out double known) ? known : 0);
        ChangePart[] parts = masses.OrderBy(m => m.Key.GameObject).Select(m =>
        {
            Rigidbody body = m.Key.Settings;
            string at = Pointer(scene, m.Key);
            string mass = EditText.Number(m.Value);
            double factor = m.Value / body.Mass;
            Vector3d inertia = body.InertiaTensor * factor;
            return new ChangePart(
                m.Key.GameObject,
                $"Rigidbody > Mass {EditText.Number(body.Mass)} -> {mass}, Inertia Tensor times {EditText.Number(factor)}",
                m.Key.Id,
                new SceneEdit(at + "/mass", mass),
                new SceneEdit(at + "/inertiaTensor", EditText.Moments(inertia)));
        }).ToArray();
        return parts.Length == 0 ? null : new Change("mass", parts);
    }

    /// <summary>The joint between unlike bodies sees the heavier one as light as the other.</summary>
    public static Change? ScaleMasses(ValidScene scene, World world)
    {
        ChangePart[] parts = UnlikeMasses(world).Select(u =>
        {
            string field = u.Heavy.GameObject == u.Joint.GameObject ? "massScale" : "connectedMassScale";
            string value = EditText.Number(u.Ratio);
            string word = field == "massScale" ? "Mass Scale" : "Connected Mass Scale";
            return new ChangePart(u.Joint.GameObject, $"{word} {value}", JointSettings.Place(scene, u.Joint), new SceneEdit(EditText.Pointer(u.Joint) + "/" + field, value));
        }).ToArray();
        return parts.Length == 0 ? null : new Change("massScale", parts);
    }

    /// <summary>
    /// For each body the radians by which its weight, held up at a joint, would turn it about each principal axis within
    /// one step: m g arm h^2 / I. Above 1 the solver corrects more in a step than the body is large.
    /// </summary>
    public static Vector3d[] TurnsInAStep(World world, double step)
    {
        var arms = new Vector3d[world.Bodies.Count];
        foreach (WorldJoint joint in world.Joints)
        {
            Reach(joint.Solved.Body0, joint.Solved.Frame0.Position);
            Reach(joint.Solved.Body1, joint.Solved.Frame1.Position);
        }

        var turns = new Vector3d[world.Bodies.Count];
        for (int i = 0; i < turns.Length; i++)
        {
            WorldBody b = world.Bodies[i];
            if (b.IsKinematic || !b.Settings.UseGravity || b.IsLink)
                continue;
            double weight = b.Settings.Mass * world.Gravity.Length * step * step;
            turns[i] = new Vector3d(Turn(b, arms[i], weight, 0), Turn(b, arms[i], weight, 1), Turn(b, arms[i], weight, 2));
        }

        return turns;

        // A joint's frame stands in the principal axes.
        void Reach(int body, Vector3d r)
        {
            if (body >= 0)
                arms[body] = new Vector3d(Math.Max(arms[body].X, Arm(r, 0)), Math.Max(arms[body].Y, Arm(r, 1)), Math.Max(arms[body].Z, Arm(r, 2)));
        }

        static double Arm(Vector3d r, int axis) => Math.Sqrt(Math.Max(0, r.LengthSquared - r[axis] * r[axis]));

        static double Turn(WorldBody body, Vector3d arms, double weight, int axis) =>
            IsFrozen(body.Settings, axis) ? 0 : weight * arms[axis] / body.Settings.InertiaTensor[axis];
    }

    /// <summary>Raises the moments of inertia that are small for the step or beside the body's largest.</summary>
    public static Change? RaiseInertias(ValidScene scene, World world)
    {
        var parts = new List<ChangePart>();
        Vector3d[] turns = TurnsInAStep(world, scene.Document.Physics.FixedTimestep);
        for (int i = 0; i < world.Bodies.Count; i++)
        {
            WorldBody body = world.Bodies[i];
            if (body.IsKinematic || body.IsLink)
                continue;
            Vector3d now = body.Settings.InertiaTensor;
            Vector3d turn = turns[i];
            double largest = Math.Max(now.X, Math.Max(now.Y, now.Z));
            var then = new Vector3d(Raised(0), Raised(1), Raised(2));
            if (then == now)
                continue;
            string value = EditText.Moments(then);
            parts.Add(new ChangePart(
                body.GameObject,
                $"Rigidbody > Inertia Tensor {EditText.Vector(now)} -> {EditText.Vector(then)}",
                body.Id,
                new SceneEdit(Pointer(scene, body) + "/inertiaTensor", value)));

            double Raised(int axis)
            {
                double share = now[axis] < ThinShare * largest ? FullShare * largest : now[axis];
                return turn[axis] > 1 ? Math.Max(share, now[axis] * turn[axis] / WeightTurn) : share;
            }
        }

        return parts.Count == 0 ? null : new Change("inertiaTensor", parts);
    }

    public static string Pointer(ValidScene scene, WorldBody body) =>
        EditText.Component(body.GameObject, scene.Document.GameObjects[body.GameObject].Components.ToList().FindIndex(c => c is Rigidbody or ArticulationBody));

    private static bool IsFrozen(Rigidbody body, int axis) =>
        (body.Constraints & (RigidbodyConstraints)((int)RigidbodyConstraints.FreezeRotationX << axis)) != 0;
}
