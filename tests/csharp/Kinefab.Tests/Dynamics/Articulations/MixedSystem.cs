using System;
using System.Linq;
using System.Text.Json;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Articulations;
using Kinefab.Dynamics.Pgs;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics.Articulations;

/// <summary>A scenario with joints on links, as bodies, joints and an articulation of one system.</summary>
internal static class MixedSystem
{
    public static (double Metres, double Radians) Compare(ReferenceArticulation scenario)
    {
        ArticulationTree tree = scenario.MakeTree();
        int links = tree.Count;
        BodyDefinition[] bodies =
        [
            .. Enumerable.Range(0, links).Select(i => Body(tree.Poses[i], tree.Links[i].Mass, tree.Links[i].Inertia, scenario) with
            {
                IsKinematic = i == 0 && tree.IsFixed,
                LinearVelocity = tree.Motions[i].Linear,
                AngularVelocity = tree.Motions[i].Angular,
            }),
            .. scenario.Bodies.Select(b => Body(ReferenceArticulation.PoseOf(b), ReferenceArticulation.Number(b, "mass", 1), ReferenceArticulation.VectorOf(b, "inertia"), scenario)),
        ];
        JointModel[] joints = [.. scenario.Joints.Select(j => Joint(scenario, j, links))];
        var system = new MultibodySystem(new Bodies(bodies), joints, []) { Gravity = scenario.Gravity };
        var articulated = new ArticulatedBodies(system, [tree], [[.. Enumerable.Range(0, links)]], new bool[joints.Length], scenario.Rules());
        var solver = new PgsSolver(system, articulated);
        double metres = 0, radians = 0;
        for (int step = 1; step <= scenario.Steps; step++)
        {
            solver.Step(scenario.StepSeconds);
            for (int i = 0; step % scenario.Sample == 0 && i < bodies.Length; i++)
            {
                Pose there = scenario.Reference(i < links ? scenario.ScenarioLink(i) : i, step / scenario.Sample - 1);
                metres = Math.Max(metres, (system.Bodies.Poses[i].Position - there.Position).Length);
                radians = Math.Max(radians, TreeKinematics.RotationVector(there.Rotation.Normalized().Conjugate() * system.Bodies.Poses[i].Rotation).Length);
            }
        }

        return (metres, radians);
    }

    private static BodyDefinition Body(Pose pose, double mass, Vector3d inertia, ReferenceArticulation scenario) => BodyDefinition.Default with
    {
        Pose = pose,
        Mass = mass,
        Inertia = inertia,
        PositionIterations = scenario.Iterations.Position,
        VelocityIterations = scenario.Iterations.Velocity,
    };

    private static D6Joint Joint(ReferenceArticulation scenario, JsonElement j, int links)
    {
        JsonElement motion = j.GetProperty("motion");
        return new D6Joint
        {
            Body0 = Actor(scenario, j, "actor0", links),
            Body1 = Actor(scenario, j, "actor1", links),
            Frame0 = ReferenceArticulation.PoseOf(j.GetProperty("frame0")),
            Frame1 = ReferenceArticulation.PoseOf(j.GetProperty("frame1")),
            Twist = Motion(motion, "twist"),
            Swing1 = Motion(motion, "swing1"),
            Swing2 = Motion(motion, "swing2"),
        };
    }

    private static AxisMotion Motion(JsonElement motion, string axis) =>
        motion.TryGetProperty(axis, out JsonElement word) && word.GetString() == "free" ? AxisMotion.Free : AxisMotion.Locked;

    private static int Actor(ReferenceArticulation scenario, JsonElement joint, string name, int links)
    {
        if (!joint.TryGetProperty(name, out JsonElement actor))
            return JointModel.World;
        return actor.TryGetProperty("link", out JsonElement link) ? scenario.TreeLink(link.GetInt32()) : links + actor.GetProperty("body").GetInt32();
    }
}
