using System;
using System.IO;
using System.Linq;
using System.Runtime.CompilerServices;
using System.Text.Json;
using Kinefab.Dynamics.Articulations;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Articulations;

/// <summary>Accelerations against those that MuJoCo gives (tests/reference/articulations/mujoco.mjs).</summary>
public sealed class MujocoTests
{
    [Test]
    public void Accelerate_RandomTrees_GivesMujocosAccelerations()
    {
        string path = Path.Combine(Path.GetDirectoryName(ThisFile())!, "..", "..", "..", "..", "reference", "articulations", "mujoco.json");
        using var document = JsonDocument.Parse(File.ReadAllText(path));
        double worst = 0;
        int freedoms = 0;
        foreach (JsonElement links in document.RootElement.EnumerateArray())
            worst = Math.Max(worst, Difference([.. links.EnumerateArray()], ref freedoms));
        TestContext.Out.WriteLine($"{freedoms} freedoms, worst {worst:0.0e+00} of the largest acceleration");
        Assert.That(freedoms, Is.GreaterThan(80));
        Assert.That(worst, Is.LessThan(1e-9));
    }

    private static double Difference(JsonElement[] links, ref int freedoms)
    {
        int[] order = ArticulationTree.DepthFirst([.. links.Select(l => l.TryGetProperty("parent", out JsonElement p) ? p.GetInt32() : -1)]);
        LinkDefinition[] definitions = [.. order.Select(old =>
        {
            JsonElement link = links[old];
            var definition = new LinkDefinition { Mass = link.GetProperty("mass").GetDouble(), Inertia = ReferenceArticulation.VectorOf(link, "inertia") };
            if (old == 0)
                return definition;
            definition.Parent = Array.IndexOf(order, link.GetProperty("parent").GetInt32());
            definition.Joint = Enum.Parse<LinkJointKind>(link.GetProperty("type").GetString()!, ignoreCase: true);
            definition.ParentAnchor = ReferenceArticulation.PoseOf(link.GetProperty("parentFrame"));
            definition.Anchor = ReferenceArticulation.PoseOf(link.GetProperty("childFrame"));
            return definition;
        })];
        var tree = new ArticulationTree(definitions, Pose.Identity, isFixed: true);
        double[] forces = new double[tree.Freedoms];
        double[] wanted = new double[tree.Freedoms];
        for (int i = 1; i < tree.Count; i++)
        {
            JsonElement link = links[order[i]];
            int f = tree.FirstFreedom[i];
            tree.Positions[f] = link.GetProperty("position").GetDouble();
            tree.Speeds[f] = link.GetProperty("speed").GetDouble();
            forces[f] = link.GetProperty("force").GetDouble();
            wanted[f] = link.GetProperty("acceleration").GetDouble();
        }

        TreeKinematics.Place(tree);
        TreeKinematics.Move(tree);
        var dynamics = new ForwardDynamics(tree);
        dynamics.Update();
        dynamics.FindInertias();
        dynamics.Accelerate(DynamicsAlgorithmTests.NetWrenches(tree), forces);
        freedoms += tree.Freedoms;
        double largest = wanted.Max(Math.Abs);
        return Enumerable.Range(0, tree.Freedoms).Max(f => Math.Abs(dynamics.JointAccelerations[f] - wanted[f])) / (1 + largest);
    }

    private static string ThisFile([CallerFilePath] string path = "") => path;
}
