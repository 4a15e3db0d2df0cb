using System;
using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Dynamics.Articulations;
using Kinefab.Joints;
using Kinefab.Mechanisms;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Dynamics;

/// <summary>
/// ArticulationBodies in PhysX's terms: degrees become radians here. A drive's targetVelocity counts as the coordinate grows, for slides as for
/// turns: that PhysX 4.1 negates a slide's (NVIDIAGameWorks/PhysX issue 411; mended in 6000.0.68 and 6000.3.9, UUM-113920) is made good where a
/// prefab is written (python: targets/prefab/objects/articulations.py, BACKWARDS), so that both editors move it alike.
/// </summary>
internal static class ArticulationModel
{
    private const double Radians = Math.PI / 180;

    /// <summary>PhysX's maxJointVelocity, which Unity leaves as it is, m/s or rad/s.</summary>
    private const double DefaultMaxSpeed = 100;

    // PhysX 4.1's gains for the drive types Target and Velocity (DyFeatherstoneArticulation.cpp, setupInternalConstraintsRecursive).
    private const double RigidGain = 1e25;

    /// <summary>The articulations of a scene.</summary>
    /// <param name="scene">What to make them from.</param>
    /// <param name="definition">Its bodies and joints.</param>
    /// <param name="system">The bodies at their start, and the joints.</param>
    /// <param name="isReduced">Whether they are solved in reduced coordinates; else by the system's joints, and this only sets positions.</param>
    public static ArticulatedBodies Of(ValidScene scene, MechanismDefinition definition, MultibodySystem system, bool isReduced)
    {
        int[] objects = definition.GameObjects;
        var jointOf = new int[objects.Length];
        var rootOf = new int[objects.Length];
        var held = new bool[system.Joints.Length];
        for (int body = 0; body < objects.Length; body++)
        {
            jointOf[body] = -1;
            rootOf[body] = scene.Document.GameObjects[objects[body]].Link is null ? -1 : body;
        }

        for (int j = 0; j < definition.Joints.Count; j++)
        {
            // A parent's object stands before its child's, and so does its body. One that is inactive leaves the link a root.
            JointDefinition joint = definition.Joints[j];
            if (joint.Link is null || joint.Connected < 0)
                continue;
            jointOf[joint.Own] = j;
            rootOf[joint.Own] = rootOf[joint.Connected];
            held[j] = isReduced;
        }

        var trees = new List<ArticulationTree>();
        var bodies = new List<int[]>();
        for (int root = 0; root < objects.Length; root++)
        {
            if (rootOf[root] == root)
                Add(scene, definition, system, root, rootOf, jointOf, trees, bodies);
        }

        return new ArticulatedBodies(system, trees, bodies, held, ArticulationRules.PhysX4);
    }

    /// <summary>Limit and drive of one axis.</summary>
    public static LinkAxis Axis(ArticulationBody link, int axis)
    {
        bool slides = link.JointType == ArticulationJointType.Prismatic;
        double unit = slides ? 1 : Radians;
        ArticulationDrive drive = axis == 0 ? link.XDrive : axis == 1 ? link.YDrive : link.ZDrive;
        ConfigurableJointMotion motion = slides && axis == 0 ? LinkJoint.SlideMotion(link) : LinkJoint.TurnMotion(link, axis);
        return new LinkAxis
        {
            Motion = (LinkMotion)motion,
            Lower = drive.LowerLimit * unit,
            Upper = drive.UpperLimit * unit,
            Stiffness = drive.DriveType switch { ArticulationDriveType.Target => RigidGain, ArticulationDriveType.Velocity => 0, _ => drive.Stiffness },
            Damping = drive.DriveType switch { ArticulationDriveType.Target => 0, ArticulationDriveType.Velocity => RigidGain, _ => drive.Damping },
            ForceLimit = drive.ForceLimit,
            IsAcceleration = drive.DriveType == ArticulationDriveType.Acceleration,
            Target = drive.Target * unit,
            TargetSpeed = drive.TargetVelocity * unit,
        };
    }

    /// <summary>What a program may change while it runs.</summary>
    public static void Apply(ArticulationBody link, LinkDefinition definition)
    {
        definition.Friction = link.JointFriction;
        definition.MaxJointSpeed = link.MaxJointVelocity ?? DefaultMaxSpeed;
        for (int axis = 0; axis < ArticulationTree.MostAxes; axis++)
            definition.Axes[axis] = Axis(link, axis);
    }

    private static void Add(
        ValidScene scene, MechanismDefinition definition, MultibodySystem system, int root, int[] rootOf, int[] jointOf, List<ArticulationTree> trees, List<int[]> bodies)
    {
        var members = new List<int>();
        for (int body = root; body < rootOf.Length; body++)
        {
            if (rootOf[body] == root)
                members.Add(body);
        }

        int[] order = ArticulationTree.DepthFirst(members.ConvertAll(body => jointOf[body] < 0 ? -1 : members.BinarySearch(definition.Joints[jointOf[body]].Connected)));
        int[] links = Array.ConvertAll(order, i => members[i]);
        var definitions = new LinkDefinition[links.Length];
        for (int i = 0; i < links.Length; i++)
        {
            ArticulationBody link = scene.Document.GameObjects[definition.GameObjects[links[i]]].Link!;
            definitions[i] = new LinkDefinition { Mass = link.Mass, Inertia = link.InertiaTensor, Joint = (LinkJointKind)link.JointType };
            Apply(link, definitions[i]);
            if (i == 0)
                continue;
            JointModel joint = system.Joints[jointOf[links[i]]];
            definitions[i].Parent = Array.IndexOf(links, definition.Joints[jointOf[links[i]]].Connected);
            definitions[i].ParentAnchor = joint.Frame0 * new Pose(new Vector3d(-LinkJoint.Middle(link), 0, 0), Quaterniond.Identity);
            definitions[i].Anchor = joint.Frame1;
        }

        var tree = new ArticulationTree(definitions, system.Bodies.Poses[root], system.Bodies.IsKinematic[root]);
        for (int i = 0; i < links.Length; i++)
            tree.Poses[i] = system.Bodies.Poses[links[i]];
        trees.Add(tree);
        bodies.Add(links);
    }
}
