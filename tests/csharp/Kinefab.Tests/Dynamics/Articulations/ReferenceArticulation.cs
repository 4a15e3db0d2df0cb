using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.Json;
using Kinefab.Dynamics.Articulations;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics.Articulations;

/// <summary>A scenario of tests/reference/articulations with PhysX's trace of it.</summary>
internal sealed class ReferenceArticulation
{
    private static readonly string[] AxisNames = ["x", "y", "z"];

    private readonly JsonElement _json;
    private readonly int[] _order;

    private ReferenceArticulation(JsonElement json)
    {
        _json = json;
        _order = ArticulationTree.DepthFirst([.. Links.Select(l => l.TryGetProperty("parent", out JsonElement p) ? p.GetInt32() : -1)]);
    }

    public string Name => _json.GetProperty("name").GetString()!;

    public string About => _json.GetProperty("about").GetString()!;

    public bool HasJoints => _json.TryGetProperty("joints", out _);

    public int Steps => (int)Number(_json, "steps", 100);

    public int Sample => (int)Number(_json, "sample", 10);

    public double StepSeconds => Number(_json, "dt", 0.02);

    public JsonElement Json => _json;

    private IEnumerable<JsonElement> Links => _json.GetProperty("links").EnumerateArray();

    public static IReadOnlyList<ReferenceArticulation> Read(string path)
    {
        using var document = JsonDocument.Parse(File.ReadAllText(path));
        return [.. document.RootElement.EnumerateArray().Select(e => new ReferenceArticulation(e.Clone()))];
    }

    /// <summary>The scenario's number of a link of the tree.</summary>
    public int ScenarioLink(int treeLink) => _order[treeLink];

    /// <summary>Where PhysX has a body after the sample-th sample; links first.</summary>
    public Pose Reference(int body, int sample) => PoseAt(_json.GetProperty("trace").GetProperty("bodies")[body], 7 * sample);

    public Pose ReferenceStart(int body) => PoseAt(_json.GetProperty("trace").GetProperty("start")[body], 0);

    public ArticulationTree MakeTree()
    {
        JsonElement[] links = [.. Links];
        LinkDefinition[] definitions = [.. _order.Select(old => Define(links[old], old))];
        JsonElement root = links[_order[0]];
        var tree = new ArticulationTree(definitions, PoseOf(root), !_json.TryGetProperty("fixed", out JsonElement isFixed) || isFixed.GetBoolean());
        for (int i = 1; i < tree.Count; i++)
        {
            JsonElement joint = links[_order[i]].GetProperty("joint");
            for (int f = tree.FirstFreedom[i]; f < tree.FirstFreedom[i + 1]; f++)
            {
                if (joint.GetProperty("axes").TryGetProperty(AxisNames[tree.AxisOf[f]], out JsonElement axis))
                {
                    tree.Positions[f] = Number(axis, "position", 0);
                    tree.Speeds[f] = Number(axis, "speed", 0);
                }
            }
        }

        if (_json.TryGetProperty("rootVelocity", out JsonElement velocity))
            tree.Motions[0] = new Twist(VectorOf(velocity, "angular"), VectorOf(velocity, "linear"));
        TreeKinematics.Place(tree);
        TreeKinematics.Move(tree);
        return tree;
    }

    /// <summary>The rules of 5.6.1, with the scenario's own compliance.</summary>
    public ArticulationRules Rules()
    {
        double compliance = Links.Select(l => Number(l, "compliance", double.NaN)).FirstOrDefault(c => !double.IsNaN(c), ArticulationRules.PhysX5.ComplianceShare);
        return ArticulationRules.PhysX5 with { ComplianceShare = compliance };
    }

    public Vector3d Gravity => _json.TryGetProperty("gravity", out _) ? VectorOf(_json, "gravity") : new Vector3d(0, -9.81, 0);

    public (int Position, int Velocity) Iterations => _json.TryGetProperty("iterations", out JsonElement i) ? (i[0].GetInt32(), i[1].GetInt32()) : (6, 1);

    /// <summary>Forces of the scenario on the links, for a step counted from 1.</summary>
    public void Apply(ArticulationSolver solver, int step)
    {
        if (!_json.TryGetProperty("forces", out JsonElement forces))
            return;
        foreach (JsonElement force in forces.EnumerateArray())
        {
            if (step <= Number(force, "until", Steps))
                solver.Applied[Array.IndexOf(_order, force.GetProperty("link").GetInt32())] += new Wrench(VectorOf(force, "force"), VectorOf(force, "torque"));
        }
    }

    /// <summary>Largest difference of any link from PhysX's, m and rad, over all samples.</summary>
    public (double Metres, double Radians) Compare()
    {
        ArticulationTree tree = MakeTree();
        var solver = new ArticulationSolver(tree, Rules());
        double metres = 0, radians = 0;
        for (int step = 1; step <= Steps; step++)
        {
            Apply(solver, step);
            solver.Step(Gravity, StepSeconds, Iterations.Position, Iterations.Velocity);
            for (int i = 0; step % Sample == 0 && i < tree.Count; i++)
            {
                Pose there = Reference(ScenarioLink(i), step / Sample - 1);
                metres = Math.Max(metres, (tree.Poses[i].Position - there.Position).Length);
                radians = Math.Max(radians, TreeKinematics.RotationVector(there.Rotation.Normalized().Conjugate() * tree.Poses[i].Rotation).Length);
            }
        }

        return (metres, radians);
    }

    /// <summary>Rigid bodies of the scenario.</summary>
    public JsonElement[] Bodies => _json.TryGetProperty("bodies", out JsonElement bodies) ? [.. bodies.EnumerateArray()] : [];

    /// <summary>Joints of the scenario.</summary>
    public JsonElement[] Joints => _json.TryGetProperty("joints", out JsonElement joints) ? [.. joints.EnumerateArray()] : [];

    /// <summary>The tree's number of a link of the scenario.</summary>
    public int TreeLink(int scenarioLink) => Array.IndexOf(_order, scenarioLink);

    private LinkDefinition Define(JsonElement link, int old)
    {
        var definition = new LinkDefinition
        {
            Mass = Number(link, "mass", 1),
            Inertia = VectorOf(link, "inertia"),
            LinearDamping = Number(link, "linearDamping", 0),
            AngularDamping = Number(link, "angularDamping", 0),
            UseGravity = !link.TryGetProperty("useGravity", out JsonElement g) || g.GetBoolean(),
        };
        if (old == _order[0])
            return definition;
        JsonElement joint = link.GetProperty("joint");
        definition.Parent = Array.IndexOf(_order, link.GetProperty("parent").GetInt32());
        definition.Joint = Enum.Parse<LinkJointKind>(joint.GetProperty("type").GetString()!, ignoreCase: true);
        definition.ParentAnchor = PoseOf(joint.GetProperty("parentFrame"));
        definition.Anchor = PoseOf(joint.GetProperty("childFrame"));
        definition.Friction = Number(joint, "friction", 0);
        definition.MaxJointSpeed = Number(joint, "maxSpeed", 1e6);
        for (int axis = 0; axis < 3; axis++)
        {
            if (!joint.GetProperty("axes").TryGetProperty(AxisNames[axis], out JsonElement a))
                continue;
            definition.Axes[axis] = new LinkAxis
            {
                Motion = a.TryGetProperty("motion", out JsonElement m) ? Enum.Parse<LinkMotion>(m.GetString()!, ignoreCase: true) : LinkMotion.Free,
                Lower = Number(a, "lower", 0),
                Upper = Number(a, "upper", 0),
                Stiffness = Number(a, "stiffness", 0),
                Damping = Number(a, "damping", 0),
                ForceLimit = Number(a, "forceLimit", double.PositiveInfinity),
                IsAcceleration = a.TryGetProperty("acceleration", out JsonElement accelerates) && accelerates.GetBoolean(),
                Target = Number(a, "target", 0),
                TargetSpeed = Number(a, "targetSpeed", 0),
            };
        }

        return definition;
    }

    public static Pose PoseOf(JsonElement e) => new(VectorOf(e, "position"), e.TryGetProperty("rotation", out JsonElement q)
        ? new Quaterniond(q[0].GetDouble(), q[1].GetDouble(), q[2].GetDouble(), q[3].GetDouble()).Normalized()
        : Quaterniond.Identity);

    public static Vector3d VectorOf(JsonElement e, string name) => e.TryGetProperty(name, out JsonElement v)
        ? new Vector3d(v[0].GetDouble(), v[1].GetDouble(), v[2].GetDouble())
        : Vector3d.Zero;

    public static double Number(JsonElement e, string name, double otherwise) => e.TryGetProperty(name, out JsonElement v) ? v.GetDouble() : otherwise;

    private static Pose PoseAt(JsonElement numbers, int at) => new(
        new Vector3d(numbers[at].GetDouble(), numbers[at + 1].GetDouble(), numbers[at + 2].GetDouble()),
        new Quaterniond(numbers[at + 3].GetDouble(), numbers[at + 4].GetDouble(), numbers[at + 5].GetDouble(), numbers[at + 6].GetDouble()));
}
