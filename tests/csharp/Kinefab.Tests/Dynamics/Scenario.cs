using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.Json;
using Kinefab.Dynamics;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics;

/// <summary>One scenario of tests/reference/scenarios.json, the list that PhysX was run on, with what PhysX made of it.</summary>
internal sealed class Scenario
{
    private readonly JsonElement _spec;
    private readonly JsonElement _trace;

    private Scenario(JsonElement spec, JsonElement trace)
    {
        _spec = spec;
        _trace = trace;
    }

    public string Name => _spec.GetProperty("name").GetString()!;

    public string About => _spec.GetProperty("about").GetString()!;

    public double Dt => Number(_spec, "dt", 0.02);

    public int Steps => _spec.GetProperty("steps").GetInt32();

    public int Sample => _spec.GetProperty("sample").GetInt32();

    public static IReadOnlyList<Scenario> All { get; } = Load();

    public static IEnumerable<string> Names => All.Select(s => s.Name);

    public static string Folder { get; } = FindFolder();

    /// <summary>Steps in which a joint broke in PhysX.</summary>
    public int[] Broken => _trace.TryGetProperty("broken", out JsonElement b) ? b.EnumerateArray().Select(e => e.GetInt32()).ToArray() : [];

    /// <summary>PhysX's pose of a body at sample k (0 is after Sample steps).</summary>
    public Pose Expected(int body, int k)
    {
        JsonElement values = _trace.GetProperty("bodies")[body];
        double At(int i) => values[7 * k + i].Exact();
        return new Pose(new Vector3d(At(0), At(1), At(2)), new Quaterniond(At(3), At(4), At(5), At(6)).Normalized());
    }

    /// <summary>A body's pose at the start.</summary>
    public Pose Start(int body) => FramePose(_spec.GetProperty("bodies")[body]);

    public MultibodySystem Build()
    {
        BodyDefinition[] bodies = _spec.GetProperty("bodies").EnumerateArray().Select(Body).ToArray();
        JointModel[] joints = _spec.GetProperty("joints").EnumerateArray().Select(ToJoint).ToArray();
        return new MultibodySystem(new Bodies(bodies), joints, []) { Gravity = Vector(_spec, "gravity", new Vector3d(0, -9.81, 0)) };
    }

    /// <summary>Sets the kinematic bodies' targets for the end of a step that ends at time t.</summary>
    public void Drive(MultibodySystem mechanism, double t)
    {
        int i = 0;
        foreach (JsonElement b in _spec.GetProperty("bodies").EnumerateArray())
        {
            if (b.TryGetProperty("kinematic", out _))
            {
                Vector3d w = Vector(b, "angularVelocity", Vector3d.Zero);
                Quaterniond turn = Quaterniond.AxisAngle(w.Normalized(), w.Length * t);
                mechanism.Bodies.KinematicTargets[i] = new Pose(
                    Vector(b, "position", Vector3d.Zero) + Vector(b, "linearVelocity", Vector3d.Zero) * t, turn * Quaternion(b, "rotation"));
            }

            i++;
        }
    }

    /// <summary>A scenario that carries its own trace.</summary>
    public static Scenario Of(JsonElement spec) => new(spec, spec);

    public override string ToString() => Name;

    private static Scenario[] Load()
    {
        using FileStream specs = File.OpenRead(Path.Combine(FindFolder(), "scenarios.json"));
        using FileStream traces = File.OpenRead(Path.Combine(FindFolder(), "traces.json"));
        JsonElement all = JsonDocument.Parse(traces).RootElement;
        return JsonDocument.Parse(specs).RootElement.EnumerateArray()
            .Select(s => new Scenario(s, all.GetProperty(s.GetProperty("name").GetString()!))).ToArray();
    }

    private static string FindFolder()
    {
        for (DirectoryInfo? d = new(AppContext.BaseDirectory); d != null; d = d.Parent)
        {
            string folder = Path.Combine(d.FullName, "tests", "reference");
            if (File.Exists(Path.Combine(folder, "scenarios.json")))
            {
                return folder;
            }
        }

        throw new DirectoryNotFoundException("tests/reference is not above the test binaries.");
    }

    private static BodyDefinition Body(JsonElement b)
    {
        BodyDefinition d = BodyDefinition.Default;
        d.Pose = FramePose(b);
        d.Mass = Number(b, "mass", 1);
        d.Inertia = Vector(b, "inertia", new Vector3d(1, 1, 1));
        d.LinearVelocity = Vector(b, "linearVelocity", Vector3d.Zero);
        d.AngularVelocity = Vector(b, "angularVelocity", Vector3d.Zero);
        d.LinearDamping = Number(b, "linearDamping", 0);
        d.AngularDamping = Number(b, "angularDamping", 0);
        d.MaxAngularSpeed = 100;
        d.UseGravity = Flag(b, "useGravity", true);
        d.IsKinematic = Flag(b, "kinematic", false);
        if (b.TryGetProperty("iterations", out JsonElement iterations))
        {
            d.PositionIterations = iterations[0].GetInt32();
            d.VelocityIterations = iterations[1].GetInt32();
        }

        if (b.TryGetProperty("locks", out JsonElement locks))
        {
            foreach (JsonElement name in locks.EnumerateArray())
            {
                d.Locks |= Enum.Parse<BodyLocks>(name.GetString()!, ignoreCase: true);
            }
        }

        return d;
    }

    private static JointModel ToJoint(JsonElement j)
    {
        JointModel joint = j.GetProperty("type").GetString() == "revolute" ? Revolute(j) : D6(j);
        joint.Body0 = j.TryGetProperty("body0", out JsonElement b0) ? b0.GetInt32() : JointModel.World;
        joint.Body1 = j.TryGetProperty("body1", out JsonElement b1) ? b1.GetInt32() : JointModel.World;
        joint.Frame0 = FramePose(j.GetProperty("frame0"));
        joint.Frame1 = FramePose(j.GetProperty("frame1"));
        joint.BreakForce = Number(j, "breakForce", double.PositiveInfinity);
        joint.BreakTorque = Number(j, "breakTorque", double.PositiveInfinity);
        joint.DriveLimitsAreForces = Flag(j, "driveLimitsAreForces", true);
        joint.Preprocessing = Flag(j, "preprocessing", true);
        joint.ExtendedLimits = Flag(j, "extendedLimits", false);
        if (j.TryGetProperty("inverseMassScales", out JsonElement s))
        {
            joint.InverseMassScale0 = s[0].Exact();
            joint.InverseInertiaScale0 = s[1].Exact();
            joint.InverseMassScale1 = s[2].Exact();
            joint.InverseInertiaScale1 = s[3].Exact();
        }

        if (j.TryGetProperty("projection", out JsonElement p))
        {
            joint.Projection = true;
            joint.ProjectionLinearTolerance = p.GetProperty("linear").Exact();
            joint.ProjectionAngularTolerance = p.GetProperty("angular").Exact();
        }

        return joint;
    }

    private static RevoluteJoint Revolute(JsonElement j)
    {
        var joint = new RevoluteJoint();
        if (j.TryGetProperty("limit", out JsonElement limit))
        {
            joint.LimitEnabled = true;
            joint.Limit = Angular(limit);
        }

        if (j.TryGetProperty("motor", out JsonElement motor))
        {
            joint.MotorEnabled = true;
            joint.MotorVelocity = motor.GetProperty("velocity").Exact();
            joint.MotorForceLimit = Number(motor, "forceLimit", double.PositiveInfinity);
            joint.MotorFreeSpin = Flag(motor, "freeSpin", false);
        }

        if (j.TryGetProperty("spring", out JsonElement spring))
        {
            joint.Spring = Drive(spring);
            joint.SpringTarget = spring.GetProperty("target").Exact();
        }

        return joint;
    }

    private static D6Joint D6(JsonElement j)
    {
        var joint = new D6Joint();
        if (j.TryGetProperty("motion", out JsonElement motion))
        {
            AxisMotion Motion(string axis) =>
                motion.TryGetProperty(axis, out JsonElement m) ? Enum.Parse<AxisMotion>(m.GetString()!, ignoreCase: true) : AxisMotion.Locked;
            joint.X = Motion("x");
            joint.Y = Motion("y");
            joint.Z = Motion("z");
            joint.Twist = Motion("twist");
            joint.Swing1 = Motion("swing1");
            joint.Swing2 = Motion("swing2");
        }

        if (j.TryGetProperty("linearLimit", out JsonElement linear))
        {
            joint.LinearLimit = new LinearLimit { Value = linear.GetProperty("value").Exact(), Response = Response(linear) };
        }

        if (j.TryGetProperty("twistLimit", out JsonElement twist))
        {
            joint.TwistLimit = Angular(twist);
        }

        if (j.TryGetProperty("swingLimit", out JsonElement swing))
        {
            joint.SwingLimit = new ConeLimit { Y = swing.GetProperty("y").Exact(), Z = swing.GetProperty("z").Exact(), Response = Response(swing) };
        }

        if (j.TryGetProperty("drives", out JsonElement drives))
        {
            DriveModel Drive(string name) => drives.TryGetProperty(name, out JsonElement d) ? Scenario.Drive(d) : default;
            joint.DriveX = Drive("x");
            joint.DriveY = Drive("y");
            joint.DriveZ = Drive("z");
            joint.DriveTwist = Drive("twist");
            joint.DriveSwing = Drive("swing");
            joint.DriveSlerp = Drive("slerp");
        }

        if (j.TryGetProperty("drivePose", out JsonElement pose))
        {
            joint.DrivePose = FramePose(pose);
        }

        if (j.TryGetProperty("driveVelocity", out JsonElement velocity))
        {
            joint.DriveLinearVelocity = Vector(velocity, "linear", Vector3d.Zero);
            joint.DriveAngularVelocity = Vector(velocity, "angular", Vector3d.Zero);
        }

        return joint;
    }

    private static DriveModel Drive(JsonElement d) => new()
    {
        Stiffness = Number(d, "stiffness", 0),
        Damping = Number(d, "damping", 0),
        ForceLimit = Number(d, "forceLimit", double.PositiveInfinity),
        IsAcceleration = Flag(d, "acceleration", false),
    };

    private static AngularLimit Angular(JsonElement limit) => new()
    {
        Lower = limit.GetProperty("lower").Exact(),
        Upper = limit.GetProperty("upper").Exact(),
        Response = Response(limit),
    };

    private static LimitResponse Response(JsonElement limit) => new()
    {
        Stiffness = Number(limit, "stiffness", 0),
        Damping = Number(limit, "damping", 0),
        Restitution = Number(limit, "restitution", 0),
        BounceThreshold = Number(limit, "bounceThreshold", 0),
        ContactDistance = Number(limit, "contactDistance", 0.01),
    };

    private static Pose FramePose(JsonElement e) => new(Vector(e, "position", Vector3d.Zero), Quaternion(e, "rotation"));

    private static Vector3d Vector(JsonElement e, string name, Vector3d otherwise) => e.TryGetProperty(name, out JsonElement v)
        ? new Vector3d(v[0].Exact(), v[1].Exact(), v[2].Exact())
        : otherwise;

    private static Quaterniond Quaternion(JsonElement e, string name) => e.TryGetProperty(name, out JsonElement v)
        ? new Quaterniond(v[0].Exact(), v[1].Exact(), v[2].Exact(), v[3].Exact()).Normalized()
        : Quaterniond.Identity;

    private static double Number(JsonElement e, string name, double otherwise) => e.TryGetProperty(name, out JsonElement v) ? v.Exact() : otherwise;

    private static bool Flag(JsonElement e, string name, bool otherwise) => e.TryGetProperty(name, out JsonElement v) ? v.GetBoolean() : otherwise;
}

/// <summary>Numbers as the library reads them: on old runtimes the framework's reader errs in the last place.</summary>
file static class ExactNumbers
{
    public static double Exact(this JsonElement number) => Kinefab.Json.LongDecimal.Parse(System.Text.Encoding.ASCII.GetBytes(number.GetRawText()));
}
