using System;
using System.Collections.Generic;
using System.Threading;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Validation;

/// <summary>Holds a document to all rules; changes and repairs nothing.</summary>
public static class SceneValidator
{
    private const int ObjectsBetweenLooks = 1024;

    /// <summary>All findings, and the valid scene when none is an error.</summary>
    /// <param name="document">A scene as it was read or made.</param>
    /// <param name="limits">Of the number of findings; null: the default ones.</param>
    /// <param name="cancellation">Ends the validation early, with an OperationCanceledException.</param>
    /// <returns>The report, and the scene where it holds no error.</returns>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public static SceneValidation Validate(SceneDocument document, SceneLimits? limits = null, CancellationToken cancellation = default)
    {
        if (document is null)
            throw new ArgumentNullException(nameof(document));
        var findings = new Findings((limits ?? SceneLimits.Default).MaxFindings);
        document.FindNulls((pointer, expected) => findings.Add(pointer, DiagnosticCodes.TypeMismatch, ("expected", expected), ("found", "null")));
        if (findings.Errors > 0)
            return new SceneValidation(null, FindingPlaces.Resolve(findings, default, hasText: false));
        Descriptions(document, findings);
        HierarchyPlaces places = GameObjects(document, findings, cancellation);
        Lists(document, places, findings);
        Buffers(document, findings, cancellation);
        ValidScene? scene = findings.Errors == 0 ? new ValidScene(document, places) : null;
        if (scene is not null)
            Placement(scene, findings);
        Report report = FindingPlaces.Resolve(findings, document.Text.Span, hasText: !document.Text.IsEmpty);
        if (scene is not null)
            scene.Report = report;
        return new SceneValidation(scene, report);
    }

    private static void Descriptions(SceneDocument document, Findings findings)
    {
        DescriptionRules.Physics(document.Physics, new Place(findings, "physics"));
        if (document.Source is SceneSource source)
            DescriptionRules.Source(source, new Place(findings, "source"));
        if (document.Analysis is Analysis analysis)
            DescriptionRules.Analysis(analysis, document.GameObjects.Count, new Place(findings, "analysis"));
    }

    // One pass over everything, since a large scene is far larger than the processor's memory for what it looked at last.
    private static HierarchyPlaces GameObjects(SceneDocument document, Findings findings, CancellationToken cancellation)
    {
        ReadOnlySpan<GameObject> objects = document.GameObjectSpan;
        var places = new HierarchyPlaces(objects.Length);
        var ids = new Dictionary<string, int>(objects.Length, StringComparer.Ordinal);
        int ground = -1;
        for (int i = 0; i < objects.Length; i++)
        {
            if (i % ObjectsBetweenLooks == 0)
                cancellation.ThrowIfCancellationRequested();
            var at = new Place(findings, "gameObjects", i);
            StructureRules.Id(objects[i], i, ids, at);
            StructureRules.Role(objects[i], i, ref ground, at);
            places.Add(objects[i]);
            GameObject(document, places, i, findings);
        }

        return places;
    }

    private static void GameObject(SceneDocument document, HierarchyPlaces places, int index, Findings findings)
    {
        ReadOnlySpan<GameObject> objects = document.GameObjectSpan;
        Rigidbody? nearestBody = places.BodyOf(index) is int mover ? objects[mover].Body : null;
        GameObject gameObject = objects[index];
        ReadOnlySpan<Component> components = gameObject.ComponentSpan;
        var at = new Place(findings, "gameObjects", index);
        StructureRules.Parent(gameObject, index, at);
        StructureRules.SingleComponents(components, index, findings);
        if (!ReferenceEquals(gameObject.Transform, Transform.Default))
        {
            TransformRules.Numbers(gameObject.Transform, at);
            TransformRules.ScaleZero(gameObject.Transform, at);
        }

        for (int c = 0; c < components.Length; c++)
        {
            var place = new Place(findings, "gameObjects", index, c);
            switch (components[c])
            {
                case MeshFilter filter:
                    NumberRules.Reference(place, "mesh", filter.Mesh, "meshes", document.Meshes.Count);
                    break;
                case MeshRenderer renderer:
                    MeshRules.Renderer(renderer, Shown(components, document), document.Materials.Count, place);
                    break;
                case Rigidbody body:
                    BodyRules.Numbers(body, place);
                    BodyRules.Mass(body, place);
                    BodyRules.Inertia(body, place);
                    break;
                case ArticulationBody link:
                    LinkRules.Numbers(link, place);
                    LinkRules.Mass(link, place);
                    LinkRules.LimitsOrder(link, place);
                    LinkRules.LockedDrives(link, place);
                    LinkRules.SphericalLocks(link, place);
                    LinkRules.Tree(document, places, index, place);
                    break;
                case Collider collider:
                    Collider(collider, document, nearestBody, place);
                    break;
                case Joint joint:
                    Joint(joint, index, objects, document.Physics.FixedTimestep, place);
                    break;
            }
        }
    }

    // The mesh beside a renderer, on whichever side of it; null where there is none.
    private static Mesh? Shown(ReadOnlySpan<Component> components, SceneDocument document)
    {
        foreach (Component component in components)
        {
            if (component is MeshFilter filter && (uint)filter.Mesh < (uint)document.Meshes.Count)
                return document.Meshes[filter.Mesh];
        }

        return null;
    }

    private static void Collider(Collider collider, SceneDocument document, Rigidbody? nearestBody, in Place at)
    {
        if (collider.Material is int material)
            NumberRules.Reference(at, "material", material, "physicsMaterials", document.PhysicsMaterials.Count);
        switch (collider)
        {
            case BoxCollider box:
                ColliderRules.Box(box, at);
                break;
            case SphereCollider sphere:
                ColliderRules.Sphere(sphere, at);
                break;
            case CapsuleCollider capsule:
                ColliderRules.Capsule(capsule, at);
                break;
            case MeshCollider mesh:
                NumberRules.Reference(at, "mesh", mesh.Mesh, "meshes", document.Meshes.Count);
                ColliderRules.Convexity(mesh, nearestBody, at);
                break;
        }
    }

    /// <summary>One that is switched off could be switched on, so it must be sound; what it would then do is not told of.</summary>
    private static void Joint(Joint joint, int index, ReadOnlySpan<GameObject> objects, double step, in Place at)
    {
        JointRules.Numbers(joint, at);
        JointRules.OwnBody(objects[index].Link is null ? objects[index].Body : null, at);
        JointRules.ConnectedBody(joint, index, objects, at);
        if (joint.Enabled)
            JointRules.Kinematic(joint, objects[index].Body, objects, at);
        if (joint is AnchoredJoint anchored)
        {
            JointRules.AnchorNumbers(anchored, at);
            JointRules.Axis(anchored, at);
            if (joint.Enabled)
                JointRules.Stated(anchored, at);
        }

        if (joint is HingeJoint hinge)
            Hinge(hinge, step, at);
        else if (joint is ConfigurableJoint configurable)
            Configurable(configurable, step, at);
    }

    private static void Hinge(HingeJoint hinge, double step, in Place at)
    {
        HingeRules.Numbers(hinge, at);
        HingeRules.LimitsOrder(hinge, at);
        if (!hinge.Enabled)
            return;
        HingeRules.LimitsEqual(hinge, at);
        HingeRules.LimitsRange(hinge, at);
        WrapRules.Hinge(hinge, step, at);
        HingeRules.MotorAndSpring(hinge, at);
        HingeRules.MotorForce(hinge, at);
    }

    private static void Configurable(ConfigurableJoint joint, double step, in Place at)
    {
        ConfigurableRules.Numbers(joint, at);
        ConfigurableRules.SecondaryAxis(joint, at);
        ConfigurableRules.AngularXLimitsOrder(joint, at);
        ConfigurableRules.SymmetricLimits(joint, at);
        DriveRules.Numbers(joint, at);
        if (!joint.Enabled)
            return;
        ConfigurableRules.AngularLimitsRange(joint, at);
        WrapRules.Twist(joint, step, at);
        ConfigurableRules.SwingLimitBesideFree(joint, at);
        ConfigurableRules.LimitWithoutRoom(joint, at);
        ConfigurableRules.BounceOfSoftLimit(joint, at);
        ConfigurableRules.SharedResponse(joint, at);
        ConfigurableRules.DamperWithoutSpring(joint, at);
        DriveRules.SlerpLocked(joint, at);
        DriveRules.OtherMode(joint, at);
        DriveRules.LockedFreedom(joint, at);
        DriveRules.MaximumForceZero(joint, at);
    }

    private static void Lists(SceneDocument document, HierarchyPlaces places, Findings findings)
    {
        for (int i = 0; i < document.Materials.Count; i++)
            LookRules.Material(document.Materials[i], document.Images.Count, new Place(findings, "materials", i));
        for (int i = 0; i < document.PhysicsMaterials.Count; i++)
            ColliderRules.Material(document.PhysicsMaterials[i], new Place(findings, "physicsMaterials", i));
        for (int i = 0; i < document.Couplings.Count; i++)
            CouplingRules.Check(document.Couplings[i], document, places, new Place(findings, "couplings", i));
        for (int i = 0; i < document.IgnoredCollisions.Count; i++)
            StructureRules.Ignored(document.IgnoredCollisions[i], document.GameObjects.Count, new Place(findings, "ignoredCollisions", i));
        for (int i = 0; i < document.Animations.Count; i++)
            AnimationRules.Check(document.Animations[i], document.GameObjects.Count, new Place(findings, "animations", i));
        for (int i = 0; i < document.Constraints.Count; i++)
            DescriptionRules.Constraint(document.Constraints[i], document.GameObjects.Count, new Place(findings, "constraints", i));
    }

    private static void Buffers(SceneDocument document, Findings findings, CancellationToken cancellation)
    {
        var usable = new bool[document.Buffers.Count];
        for (int i = 0; i < usable.Length; i++)
        {
            cancellation.ThrowIfCancellationRequested();
            usable[i] = BufferRules.Check(document.Buffers[i], new Place(findings, "buffers", i), cancellation);
        }

        for (int i = 0; i < document.Meshes.Count; i++)
        {
            cancellation.ThrowIfCancellationRequested();
            Mesh(document, document.Meshes[i], usable, new Place(findings, "meshes", i));
        }

        for (int i = 0; i < document.Images.Count; i++)
            LookRules.Image(document.Images[i], usable, document, new Place(findings, "images", i));
    }

    private static void Mesh(SceneDocument document, Mesh mesh, bool[] usable, in Place at)
    {
        MeshRules.Numbers(mesh, at);
        MeshRules.Submeshes(mesh, at);
        long vertices = Math.Max(0, mesh.VertexCount);
        bool positions = BufferRules.Accessor(mesh.Positions, vertices * 12, usable, document, "positions", at);
        bool indices = BufferRules.Accessor(mesh.Indices, MeshData.IndexBytes(mesh), usable, document, "indices", at);
        BufferRules.Accessor(mesh.Normals, vertices * 12, usable, document, "normals", at);
        for (int set = 0; set < MeshData.UvSets; set++)
        {
            if (MeshData.UvAccessor(mesh, set) is Accessor uv)
                BufferRules.Accessor(uv, vertices * 8, usable, document, set == 0 ? "uv" : "uv" + Invariant.Text(set + 1), at);
        }

        BufferRules.Accessor(mesh.Tangents, vertices * 16, usable, document, "tangents", at);
        BufferRules.Accessor(mesh.Colors, vertices * 16, usable, document, "colors", at);
        if (positions)
            BufferRules.FinitePositions(MeshData.Bytes(document, mesh.Positions, vertices * 12), at);
        if (indices)
            BufferRules.IndexRange(mesh, MeshData.Bytes(document, mesh.Indices, MeshData.IndexBytes(mesh)), at);
    }

    /// <summary>Rules that need every object's place in the world.</summary>
    private static void Placement(ValidScene scene, Findings findings)
    {
        ReadOnlySpan<GameObject> objects = scene.Document.GameObjectSpan;
        for (int i = 0; i < objects.Length; i++)
        {
            if (objects[i].Parent is int parent)
                TransformRules.Skew(objects[i].Transform, scene.WorldTransform(parent).Scale, new Place(findings, "gameObjects", i));
            ReadOnlySpan<Component> components = objects[i].ComponentSpan;
            for (int c = 0; c < components.Length; c++)
            {
                if (components[c] is AnchoredJoint { Enabled: true } joint)
                    Anchors(joint, scene, i, new Place(findings, "gameObjects", i, c));
                else if (components[c] is ArticulationBody link && scene.LinkAbove(i) is int above)
                    LinkRules.Anchors(link, scene.WorldTransform(i), scene.WorldTransform(above), new Place(findings, "gameObjects", i, c));
            }
        }
    }

    private static void Anchors(AnchoredJoint joint, ValidScene scene, int index, in Place at)
    {
        WorldTransform own = scene.WorldTransform(index);
        WorldTransform connected = scene.Connected(joint);
        AnchorRules.ConnectedAnchorRecomputed(joint, own, connected, at);
        if (joint is HingeJoint hinge)
            AnchorRules.Hinge(hinge, own, connected, at);
        else if (joint is ConfigurableJoint configurable)
            AnchorRules.Configurable(configurable, own, connected, at);
    }
}
