using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;
using Quaterniond = Kinefab.Numerics.Quaterniond;

namespace Kinefab.Tests.Dynamics.Articulations;

/// <summary>Arms in a row along X, made in code: each link's joint lies between it and the one before, at half a metre from either.</summary>
internal static class LinkScene
{
    /// <summary>X of the anchor along Z of the link.</summary>
    public static readonly Quaterniond AboutZ = new Quaterniond(0, -1, 0, 1).Normalized();

    public static readonly ArticulationBody Base = new() { Mass = 3, InertiaTensor = new Vector3d(0.3, 0.2, 0.25), Immovable = true };

    public static ArticulationBody Link(ArticulationJointType type, ArticulationDrive? drive = null, double mass = 2) => new()
    {
        Mass = mass,
        InertiaTensor = new Vector3d(0.05, 0.12, 0.1),
        AngularDamping = 0,
        JointType = type,
        TwistLock = ConfigurableJointMotion.Free,
        SwingYLock = ConfigurableJointMotion.Free,
        SwingZLock = ConfigurableJointMotion.Free,
        LinearLock = ConfigurableJointMotion.Free,
        AnchorPosition = new Vector3d(-0.5, 0, 0),
        ParentAnchorPosition = new Vector3d(0.5, 0, 0),
        AnchorRotation = type == ArticulationJointType.Revolute ? AboutZ : Quaterniond.Identity,
        ParentAnchorRotation = type == ArticulationJointType.Revolute ? AboutZ : Quaterniond.Identity,
        XDrive = drive ?? ArticulationDrive.Default,
    };

    public static SceneDocument Document(ArticulationBody root, IEnumerable<ArticulationBody> links, params GameObject[] more)
    {
        var objects = new List<GameObject> { new() { Id = "L0", Name = "L0", Components = [root] } };
        foreach (ArticulationBody link in links)
        {
            string id = $"L{objects.Count}";
            objects.Add(new GameObject
            {
                Id = id,
                Name = id,
                Parent = objects.Count - 1,
                Transform = new Transform { LocalPosition = new Vector3d(1, 0, 0) },
                Components = [link],
            });
        }

        return new SceneDocument { GameObjects = [.. objects, .. more] };
    }

    public static ValidScene Scene(ArticulationBody root, params ArticulationBody[] links) => Valid(Document(root, links));

    public static ValidScene Valid(SceneDocument document)
    {
        SceneValidation found = SceneValidator.Validate(document);
        Assert.That(found.Scene, Is.Not.Null, string.Join("\n", found.Report.Diagnostics.Select(d => d.ToString())));
        return found.Scene!;
    }

    public static World World(SolverKind solver, params ArticulationBody[] links) => Kinefab.Dynamics.World.Create(Scene(Base, links), solver);
}
