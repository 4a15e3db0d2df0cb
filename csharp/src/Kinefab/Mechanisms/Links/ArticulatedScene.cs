using System;
using System.Collections.Generic;
using System.Globalization;
using System.Threading;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Mechanisms;

/// <summary>
/// A scene whose bodies are ArticulationBodies: the tree of its joints becomes the tree of its objects, and what closes a loop stays a joint, on a helper body
/// that is fixed to one of the two links. It is the scene that <c>kinefab export --physics articulation</c> writes of the same source.
/// </summary>
public static class ArticulatedScene
{
    // Of the link that a helper body is fixed to.
    private const double HelperMass = 0.05;

    // Of one articulation: DY_ARTICULATION_MAX_SIZE of PhysX 4.1, whose arrays have that size.
    private const int MostLinks = 64;

    /// <summary>The scene with links for the Rigidbodies that joints connect; as it is where it has links, or no joints.</summary>
    /// <param name="scene">With the poses of its file.</param>
    /// <param name="report">What links have no place for, and where there is no scene which joints no articulation can have; places are those of <paramref name="scene"/>.</param>
    /// <param name="cancellation">Ends it early, with an OperationCanceledException.</param>
    /// <returns>Null where an articulation cannot hold all of its joints.</returns>
    public static ValidScene? Of(ValidScene scene, out Report report, CancellationToken cancellation = default)
    {
        if (scene is null)
            throw new ArgumentNullException(nameof(scene));
        report = Report.Empty;
        foreach (GameObject gameObject in scene.Document.GameObjects)
        {
            if (gameObject.Link is not null)
                return scene;
        }

        var findings = new List<Diagnostic>();
        SceneDocument made = Make(scene, findings, cancellation);
        report = new Report(findings);
        if (report.HasErrors)
            return null;
        SceneValidation validation = SceneValidator.Validate(made, cancellation: cancellation);
        if (validation.Scene is null)
            report = report.Concat(validation.Report);
        return validation.Scene;
    }

    private static SceneDocument Make(ValidScene scene, List<Diagnostic> findings, CancellationToken cancellation)
    {
        SceneDocument document = scene.Document;
        var tree = new LinkTree(document, findings);
        TellSize(tree, findings);
        List<GameObject> objects = WithoutJoints(tree, scene, findings);
        var told = new ToldLosses(document.Report);
        var components = new Dictionary<int, List<Component>>();
        var moved = new Dictionary<JointPlace, JointCoordinate>();
        var poses = new LinkPoses(scene);
        foreach (Branch branch in tree.Branches)
        {
            cancellation.ThrowIfCancellationRequested();
            ArticulationBody link = Link(tree, branch, poses, told, findings);
            List<Component> own = InPlaceOfBody(objects[branch.Child].Components, link);
            objects[branch.Child] = Below(objects[branch.Child], branch, poses) with { Components = own };
            components[branch.Child] = own;
            if (branch.Joint is JointPlace inner)
                moved[inner] = new JointCoordinate { GameObject = branch.Child, Component = own.IndexOf(link) };
        }

        var ids = new FreeIds(objects);
        foreach (JointPlace closing in tree.Closing)
        {
            cancellation.ThrowIfCancellationRequested();
            moved[closing] = new JointCoordinate { GameObject = objects.Count, Component = 2 };
            objects.Add(Helper(tree, closing, components[closing.GameObject], poses, ids, findings));
        }

        return ParentsFirst.Of(document with
        {
            GameObjects = objects,
            Couplings = Couplings(tree, document.Couplings, moved, components, findings),
            Animations = Clips(document, components, findings),
            Report = told.Left,
        });
    }

    private static ArticulationBody Link(LinkTree tree, Branch branch, LinkPoses poses, ToldLosses told, List<Diagnostic> findings)
    {
        Rigidbody body = tree.Bodies[branch.Child];
        var link = new ArticulationBody
        {
            Mass = body.Mass,
            LinearDamping = body.LinearDamping,
            AngularDamping = body.AngularDamping,
            CenterOfMass = body.CenterOfMass,
            InertiaTensor = body.InertiaTensor,
            InertiaTensorRotation = body.InertiaTensorRotation,
            UseGravity = body.UseGravity,
            Immovable = body.IsKinematic,
            CollisionDetectionMode = body.CollisionDetectionMode,
        };
        if (branch.Joint is not JointPlace place || branch.Parent is not int parent)
            return link;

        Joint joint = tree.Joint(place);
        string name = tree.NameOf(place);
        ArticulationBody? moving = null;
        string? reason = poses.WhyScaled(branch.Child, branch.Parent) ?? LinkFreedoms.Set(link, joint, poses.Start(joint, place.GameObject, tree.Other(place)), out moving);
        if (reason is not null || moving is null)
        {
            findings.Add(Diagnostic.Of(DiagnosticCodes.ArticulationImpossible, place.Pointer, ("joint", name), ("detail", reason ?? "")));
            return link;
        }

        bool onChild = place.GameObject == branch.Child;
        moving = LinkRanges.Widened(moving, joint, onChild, name, told);
        if (joint is AnchoredJoint anchored && moving.JointType != ArticulationJointType.Fixed)
            moving = LinkBounds.Set(moving, anchored, name, place.Pointer, told, findings);
        LinkLosses.Tell(joint, body, name, place.Pointer, tree.Objects[branch.Child].Id, findings);
        Pose frame = poses.Frame(joint, place.GameObject, tree.Other(place), branch.Child, onChild);
        Pose inner = poses[branch.Child].Inverse() * frame, outer = poses[parent].Inverse() * frame;
        return moving with
        {
            Because = joint.Because,
            ExtrasJson = JointExtras.WithName(joint),
            AnchorPosition = inner.Position,
            AnchorRotation = LinkPoses.Upright(inner.Rotation),
            ParentAnchorPosition = outer.Position,
            ParentAnchorRotation = LinkPoses.Upright(outer.Rotation),
        };
    }

    // Joints stand elsewhere now, or are left out.
    private static List<GameObject> WithoutJoints(LinkTree tree, ValidScene scene, List<Diagnostic> findings)
    {
        var links = new HashSet<int>();
        foreach (Branch branch in tree.Branches)
            links.Add(branch.Child);
        var found = new List<GameObject>(tree.Objects);
        for (int i = 0; i < scene.Document.GameObjects.Count; i++)
        {
            bool isOfLink = scene.BodyOf(i) is int body && links.Contains(body);
            var left = new List<Component>(isOfLink ? LinkColliders.Convex(scene, i, findings) : found[i].Components);
            left.RemoveAll(component => component is Joint);
            found[i] = found[i] with { Components = left };
        }

        return found;
    }

    // The object that stands for the world has no body.
    private static List<Component> InPlaceOfBody(IReadOnlyList<Component> components, ArticulationBody link)
    {
        var own = new List<Component>(components);
        int body = own.FindIndex(component => component is Rigidbody);
        if (body < 0)
            own.Add(link);
        else
            own[body] = link;
        return own;
    }

    // The same place in the world, below another object.
    private static GameObject Below(GameObject entry, Branch branch, LinkPoses poses)
    {
        Pose local = branch.Parent is int parent ? poses[parent].Inverse() * poses[branch.Child] : poses[branch.Child];
        return entry with { Parent = branch.Parent, Transform = LinkPoses.Place(local) };
    }

    // The joint on a body of its own, which is fixed to the link that had it.
    private static GameObject Helper(LinkTree tree, JointPlace closing, List<Component> components, LinkPoses poses, FreeIds ids, List<Diagnostic> findings)
    {
        var link = (ArticulationBody)components.Find(component => component is ArticulationBody)!;
        Joint joint = tree.Joint(closing);
        string id = joint.Id ?? "", name = id.Length > 0 ? id : tree.Objects[closing.GameObject].Name;
        var body = new Rigidbody
        {
            Mass = HelperMass * link.Mass,
            CenterOfMass = link.CenterOfMass,
            InertiaTensor = HelperMass * link.InertiaTensor,
            InertiaTensorRotation = link.InertiaTensorRotation,
            UseGravity = false,
        };
        findings.Add(Diagnostic.Of(DiagnosticCodes.ArticulationLoopHelper, closing.Pointer, ("joint", name), ("object", $"{name} closure")));
        return new GameObject
        {
            Id = ids.Take($"kinefab:helper {tree.NameOf(closing)}"),
            Name = $"{name} closure",
            Transform = LinkPoses.Place(poses[closing.GameObject]),
            Components = new Component[] { body, new FixedJoint { ConnectedBody = closing.GameObject, Id = $"{id} helper" }, joint with { ConnectedBody = tree.Other(closing) } },
        };
    }

    // Between the same motions: a link's coordinates count as those of the joint that it stands for.
    private static List<Coupling> Couplings(LinkTree tree, IReadOnlyList<Coupling> couplings, Dictionary<JointPlace, JointCoordinate> moved, Dictionary<int, List<Component>> links, List<Diagnostic> findings)
    {
        JointPlace? missing = null;
        JointCoordinate Now(JointCoordinate at)
        {
            var was = new JointPlace(at.GameObject, at.Component);
            if (!moved.TryGetValue(was, out JointCoordinate? place))
            {
                missing ??= was; // switched off
                return at;
            }

            bool isTurn = links.ContainsKey(place.GameObject) && at.Coordinate == Coordinate.Angle;
            return place with { Coordinate = isTurn ? Coordinate.AngularX : at.Coordinate };
        }

        var found = new List<Coupling>();
        for (int i = 0; i < couplings.Count; i++)
        {
            missing = null;
            Coupling coupling = MovedCouplings.Of(couplings[i], Now);
            if (missing is JointPlace off)
                findings.Add(Diagnostic.Of(DiagnosticCodes.CouplingWithoutJoint, $"/couplings/{i}", ("coupling", coupling.Id ?? $"coupling:{i}"), ("joint", tree.NameOf(off))));
            else
                found.Add(coupling);
        }

        return found;
    }

    // Without what moves links: no Transform moves them, and they stand below other objects now.
    private static List<AnimationClip> Clips(SceneDocument document, Dictionary<int, List<Component>> links, List<Diagnostic> findings)
    {
        var found = new List<AnimationClip>();
        for (int c = 0; c < document.Animations.Count; c++)
        {
            AnimationClip clip = document.Animations[c];
            var left = new List<AnimationTrack>();
            foreach (AnimationTrack track in clip.Tracks)
            {
                if (links.ContainsKey(track.GameObject))
                    findings.Add(LinkLosses.Dropped($"clip {clip.Name} of {document.GameObjects[track.GameObject].Id}", "an animation of a link", $"/animations/{c}"));
                else
                    left.Add(track);
            }

            if (left.Count > 0)
                found.Add(clip with { Tracks = left });
        }

        return found;
    }

    private static void TellSize(LinkTree tree, List<Diagnostic> findings)
    {
        var roots = new Dictionary<int, int>();
        var counts = new Dictionary<int, int>();
        foreach (Branch branch in tree.Branches)
        {
            int root = branch.Parent is int parent ? roots[parent] : branch.Child;
            roots[branch.Child] = root;
            counts[root] = counts.TryGetValue(root, out int count) ? count + 1 : 1;
        }

        foreach ((int root, int count) in counts)
        {
            if (count > MostLinks)
                findings.Add(Diagnostic.Of(DiagnosticCodes.ArticulationLinksMany, "", ("object", tree.Objects[root].Id), ("count", count.ToString(CultureInfo.InvariantCulture))));
        }
    }
}
