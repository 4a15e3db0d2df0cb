using System;
using System.Collections.Generic;
using System.Diagnostics;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Json;
using Kinefab.Numerics;

namespace Kinefab.Validation;

/// <summary>A scene without errors: every reference resolves, every number is one that Unity takes.  Only <c>SceneValidator</c> makes one.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed partial class ValidScene
{
    private readonly HierarchyPlaces places;

    internal ValidScene(SceneDocument document)
        : this(document, HierarchyPlaces.Of(document))
    {
    }

    internal ValidScene(SceneDocument document, HierarchyPlaces places)
    {
        Document = document;
        this.places = places;
    }

    /// <summary>The scene as it stands in the file.</summary>
    public SceneDocument Document { get; }

    /// <summary>
    /// What was found besides errors, of which there are none: after <c>Load</c> the warnings of reading and of validating, after
    /// <see cref="SceneValidator.Validate"/> those of validating.
    /// </summary>
    public Report Report { get; internal set; } = Report.Empty;

    /// <summary>Pose and scale of a GameObject in the world, as exported; metres.</summary>
    /// <param name="gameObject">Index of the GameObject.</param>
    /// <returns>Unity's left-handed frame, metres.</returns>
    /// <exception cref="ArgumentOutOfRangeException">There is no such GameObject.</exception>
    public WorldTransform WorldTransform(int gameObject) => places.World(Index(gameObject));

    /// <summary>The numbers of a mesh.</summary>
    /// <param name="mesh">Index of the mesh.</param>
    /// <returns>Positions in metres, in the frame of the GameObject that shows the mesh.</returns>
    /// <exception cref="ArgumentOutOfRangeException">There is no such mesh.</exception>
    public MeshData Mesh(int mesh) =>
        new(Document, (uint)mesh < (uint)Document.Meshes.Count ? Document.Meshes[mesh] : throw new ArgumentOutOfRangeException(nameof(mesh), $"The scene has {Document.Meshes.Count} meshes."));

    /// <summary>What a joint leaves to its own body.</summary>
    /// <param name="gameObject">Index of the GameObject that carries the joint.</param>
    /// <param name="component">Index of the joint in its components.</param>
    /// <returns>One entry a free or limited motion; none where all six are locked.</returns>
    /// <exception cref="ArgumentOutOfRangeException">There is no such GameObject or component, or it is no joint.</exception>
    public IReadOnlyList<JointFreedom> Freedoms(int gameObject, int component)
    {
        Joint joint = JointAt(gameObject, component, nameof(component));
        return JointFreedoms.Of(joint, WorldTransform(gameObject), Connected(joint));
    }

    /// <summary>
    /// From where a ConfigurableJoint's connected anchor stands to its own anchor: what Unity's linear coordinates, which count from where
    /// the anchors meet, are at the exported pose.
    /// </summary>
    /// <param name="gameObject">Index of the GameObject.</param>
    /// <param name="component">Index of the joint in its components.</param>
    /// <returns>Along the joint's X, Y and Z, metres; zero where Unity works the connected anchor out, and of other joints.</returns>
    /// <exception cref="ArgumentOutOfRangeException">There is no such GameObject or component, or it is no joint.</exception>
    public Vector3d AnchorGap(int gameObject, int component) =>
        JointAt(gameObject, component, nameof(component)) is ConfigurableJoint joint
            ? JointAnchors.StartGap(joint, WorldTransform(gameObject), Connected(joint))
            : Vector3d.Zero;

    /// <summary>Where the connected body of a joint stands; the world's own place when there is none.</summary>
    internal WorldTransform Connected(Joint joint) =>
        joint.ConnectedBody is int body ? WorldTransform(body) : new WorldTransform(Pose.Identity, new Vector3d(1, 1, 1));

    /// <summary>The Rigidbody of a GameObject, or its ArticulationBody as one; null when it has neither.</summary>
    /// <param name="gameObject">Index of the GameObject.</param>
    /// <returns>The component as the file states it: kg, metres, radians per second; null without one.</returns>
    /// <exception cref="ArgumentOutOfRangeException">There is no such GameObject.</exception>
    public Rigidbody? Body(int gameObject) => Document.GameObjects[Index(gameObject)].Body;

    /// <summary>Whether a GameObject's ArticulationBody is the root of its articulation; false without one.</summary>
    /// <param name="gameObject">Index of the GameObject.</param>
    /// <returns>True for the one link of an articulation that hangs on no other.</returns>
    /// <exception cref="ArgumentOutOfRangeException">There is no such GameObject.</exception>
    public bool IsRootLink(int gameObject) => Document.GameObjects[Index(gameObject)].Link is not null && places.LinkAbove(gameObject) is null;

    /// <summary>The GameObject whose Rigidbody moves this one: itself or its nearest ancestor that has one; null: nothing does.</summary>
    /// <param name="gameObject">Index of the GameObject.</param>
    /// <returns>Index of a GameObject, or null.</returns>
    /// <exception cref="ArgumentOutOfRangeException">There is no such GameObject.</exception>
    public int? BodyOf(int gameObject) => places.BodyOf(Index(gameObject));

    /// <summary>The GameObject of the link above one; null: there is none.</summary>
    internal int? LinkAbove(int gameObject) => places.LinkAbove(gameObject);

    /// <summary>A GameObject's link as a joint to the link above; null for a root, and without one.</summary>
    internal Joint? Held(int gameObject) => LinkJoint.Of(Document, places, gameObject);

    /// <summary>Whether a GameObject and all above it are active.</summary>
    internal bool IsActive(int gameObject) => places.IsActive(gameObject);

    /// <summary>The joint that a coupling refers to.</summary>
    /// <param name="coordinate">One end of a coupling.</param>
    /// <returns>The component, on the GameObject that the reference names.</returns>
    /// <exception cref="ArgumentOutOfRangeException">It names no joint of this scene.</exception>
    public Joint Joint(JointCoordinate coordinate)
    {
        if (coordinate is null)
            throw new ArgumentNullException(nameof(coordinate));
        return JointAt(coordinate.GameObject, coordinate.Component, nameof(coordinate));
    }

    /// <summary>How many objects, bodies and joints there are.</summary>
    public override string ToString()
    {
        int bodies = 0;
        int joints = 0;
        foreach (GameObject gameObject in Document.GameObjects)
        {
            bodies += gameObject.Body is null ? 0 : 1;
            foreach (Component component in gameObject.Components)
                joints += component is Joint { Enabled: true } ? 1 : 0;
        }

        for (int i = 0; i < Document.GameObjects.Count; i++)
            joints += Held(i) is null ? 0 : 1;

        return $"scene of {Invariant.Counted(Document.GameObjects.Count, "object")}, {Invariant.Counted(bodies, "body", "bodies")}, {Invariant.Counted(joints, "joint")}, {Invariant.Counted(Document.Couplings.Count, "coupling")}; {Report}";
    }

    private int Index(int gameObject) => (uint)gameObject < (uint)places.Count
        ? gameObject
        : throw new ArgumentOutOfRangeException(nameof(gameObject), $"The scene has {places.Count} objects.");

    private Joint JointAt(int gameObject, int component, string argument)
    {
        IReadOnlyList<Component> components = Document.GameObjects[Index(gameObject)].Components;
        if ((uint)component < (uint)components.Count && components[component] is ArticulationBody && Held(gameObject) is Joint held)
            return held;
        return (uint)component < (uint)components.Count && components[component] is Joint joint
            ? joint
            : throw new ArgumentOutOfRangeException(argument, $"Component {component} of {Document.GameObjects[gameObject].Id} is no joint.");
    }
}
