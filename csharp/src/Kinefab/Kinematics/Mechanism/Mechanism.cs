using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Linq;
using System.Threading;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Joints;
using Kinefab.Json;
using Kinefab.Mechanisms;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Kinematics;

/// <summary>
/// What of a scene moves and how it hangs together: bodies, joints, couplings, and a spanning tree over them. Never
/// changes; many states and solvers can share it. Drives, motors and springs do not matter at position level, and every
/// limit is taken for a hard one.
/// </summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed partial class Mechanism
{
    private readonly int[] _bodyOf;
    private readonly Pose[] _locals;
    private readonly Pose[] _start;
    private readonly MechanismCoordinate[] _coordinates;
    private readonly Dictionary<(int GameObject, int Component, Coordinate Coordinate), int> _coordinateAt = new();
    private readonly CoordinateNames _names;

    private Mechanism(ValidScene scene)
    {
        Scene = scene;
        MechanismDefinition definition = MechanismDefinition.From(scene);
        _bodyOf = definition.BodyOf;
        GameObjects = definition.GameObjects;
        var isFixed = new bool[GameObjects.Length];
        _start = new Pose[GameObjects.Length];
        for (int i = 0; i < GameObjects.Length; i++)
        {
            isFixed[i] = scene.Body(GameObjects[i])!.IsKinematic;
            _start[i] = scene.WorldTransform(GameObjects[i]).Pose;
        }

        int objects = scene.Document.GameObjects.Count;
        _locals = new Pose[objects];
        for (int i = 0; i < objects; i++)
        {
            Pose world = scene.WorldTransform(i).Pose;
            _locals[i] = _bodyOf[i] < 0 ? world : _start[_bodyOf[i]].Inverse() * world;
        }

        var isClosure = new List<bool>();
        var joints = new List<JointModel>();
        foreach (JointModel joint in definition.MakeJoints(scene, _start))
        {
            isClosure.Add(definition.Joints[joints.Count].Source.Closure);
            joints.Add(PositionJoint.From(joint));
        }

        for (int i = 0; i < GameObjects.Length; i++)
        {
            if (PositionJoint.Freeze(i, _start[i], scene.Body(GameObjects[i])!.Constraints) is JointModel freeze)
            {
                isClosure.Add(false);
                joints.Add(freeze);
            }
        }

        HoldsNothing = new bool[joints.Count];
        for (int j = 0; j < definition.Joints.Count; j++)
        {
            HoldsNothing[j] = MotionSubspace.LockedAxes(joints[j]) == 0 && JointExtras.KeepsApart(definition.Joints[j].Source);
        }

        JointPlaces = new (int, int)[definition.Joints.Count];
        for (int j = 0; j < JointPlaces.Length; j++)
        {
            JointPlaces[j] = (definition.Joints[j].GameObject, definition.Joints[j].Component);
        }

        JointModel[] all = joints.ToArray();
        _coordinates = MechanismCoordinates.Of(definition, all, HoldsNothing, scene.Document.Couplings);
        foreach (MechanismCoordinate coordinate in _coordinates)
        {
            JointModel rows = coordinate.JointRows;
            coordinate.Zero = coordinate.Evaluate(Linkage.PoseOf(rows.Body0, _start), Linkage.PoseOf(rows.Body1, _start), 0, out _);
        }

        CoordinatePlace[] places = Array.ConvertAll(_coordinates, c => new CoordinatePlace(c.GameObject, c.Component, c.Coordinate, c.IsLocked));
        _names = new CoordinateNames(scene.Document.GameObjects, places);
        for (int i = 0; i < _coordinates.Length; i++)
        {
            _coordinates[i].TakeName(_names, i);
            _coordinateAt[(_coordinates[i].GameObject, _coordinates[i].Component, _coordinates[i].Coordinate)] = i;
        }

        PositionCoupling[] couplings = PositionCoupling.Of(scene.Document.Couplings, _coordinates);
        Vector3d origin = MechanismScale.Center(all, _start);
        double length = MechanismScale.LinkLength(all, _start);
        Linkage = new Linkage(isFixed, all, isClosure.ToArray(), _coordinates, couplings, origin, length);
    }

    /// <summary>The scene it was made from.</summary>
    public ValidScene Scene { get; }

    /// <summary>All unlocked joint coordinates, in order of GameObject, component and axis; then locked ones that couplings name.</summary>
    public IReadOnlyList<MechanismCoordinate> Coordinates => _coordinates;

    /// <summary>The GameObjects that carry Rigidbodies, by index: what has to be placed to show a state.</summary>
    public IReadOnlyList<int> Bodies => GameObjects;

    /// <summary>What the solvers work on.</summary>
    internal Linkage Linkage { get; }

    internal int BodyCount => GameObjects.Length;

    /// <summary>For each body the GameObject with its Rigidbody.</summary>
    internal int[] GameObjects { get; }

    /// <summary>The components' joints, then those that frozen motions amount to.</summary>
    internal JointModel[] Joints => Linkage.Joints;

    /// <summary>For each joint whether it only keeps its bodies from colliding: it closes no loop and joins no islands.</summary>
    internal bool[] HoldsNothing { get; }

    /// <summary>For each joint of a component where it stands.</summary>
    internal (int GameObject, int Component)[] JointPlaces { get; }

    internal PositionCoupling[] Couplings => Linkage.Couplings;

    internal KinematicTree Tree => Linkage.Tree;

    internal MechanismRows Rows => Linkage.Rows;

    internal double Length => Linkage.Length;

    /// <summary>The mechanism of a scene file.</summary>
    /// <param name="path">A scene file, NAME.kinefab.</param>
    /// <param name="options">Null: unknown fields are warnings, limits the default ones.</param>
    /// <param name="cancellation">Ends the reading early.</param>
    /// <returns>The mechanism; warnings stand in its scene's <see cref="ValidScene.Report"/>.</returns>
    /// <exception cref="SceneFormatException">The file has errors; the exception holds the report.</exception>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    /// <example><code>
    /// Mechanism mechanism = Mechanism.Load("lever.kinefab");
    /// SweepResult sweep = mechanism.Sweep("Shaft", 0, 360, 72);
    /// Console.WriteLine(sweep["Slide"].Max() - sweep["Slide"].Min());
    /// </code></example>
    public static Mechanism Load(string path, SceneReadOptions? options = null, CancellationToken cancellation = default) =>
        Create(ValidScene.Load(path, options, cancellation));

    /// <summary>The mechanism of a scene.</summary>
    /// <param name="scene">A valid one, see <see cref="ValidScene.Load(string, SceneReadOptions?, CancellationToken)"/>.</param>
    /// <returns>Its coordinates are zero at the exported pose.</returns>
    public static Mechanism Create(ValidScene scene)
    {
        if (scene is null)
            throw new ArgumentNullException(nameof(scene));
        return new Mechanism(scene);
    }

    /// <summary>Index of a joint's coordinate in <see cref="Coordinates"/>; -1 when the joint has it locked, unless a coupling names it, or is not there.</summary>
    /// <param name="gameObject">Index of the GameObject that carries the joint.</param>
    /// <param name="component">Index of the joint among its components.</param>
    /// <param name="coordinate">Which of the joint's motions.</param>
    /// <returns>An index, or -1.</returns>
    public int FindCoordinate(int gameObject, int component, Coordinate coordinate) =>
        _coordinateAt.TryGetValue((gameObject, component, coordinate), out int found) ? found : -1;

    /// <summary>
    /// Finds a coordinate by what the source calls its joint (Shaft), else by its GameObject's id or name
    /// (Lever/Crank:1), with [COMPONENT] behind either where the object carries several joints (Arm[3]), and with the coordinate
    /// behind that where the joint has several (Arm[3].angularX). A <see cref="MechanismCoordinate.Name"/> always finds its own.
    /// </summary>
    /// <param name="name">Such as Shaft, Shaft.angle, Lever/Crank:1 or Lever/Crank:1.angle.</param>
    /// <param name="coordinate">Index into <see cref="Coordinates"/>; -1: none answers, or several do.</param>
    /// <param name="problem">What is wrong with the name and which there are; empty: nothing.</param>
    /// <returns>True where just one coordinate answers to the name.</returns>
    /// <exception cref="ArgumentNullException">There is no name.</exception>
    public bool TryFindCoordinate(string name, out int coordinate, out string problem) =>
        _names.TryFind(name ?? throw new ArgumentNullException(nameof(name)), out coordinate, out problem);

    /// <summary>As <see cref="TryFindCoordinate"/>, for names that are known to be right.</summary>
    /// <param name="name">Such as Shaft or Lever/Crank:1.angle.</param>
    /// <returns>Index into <see cref="Coordinates"/>.</returns>
    /// <exception cref="ArgumentException">None answers to the name, or several do: the message says which there are.</exception>
    public int CoordinateNamed(string name) =>
        TryFindCoordinate(name, out int coordinate, out string problem) ? coordinate : throw new ArgumentException($"{name}: {problem}", nameof(name));

    /// <summary>Index of the GameObject with an id, or with a name that no other has.</summary>
    /// <param name="idOrName">Such as Lever/Crank:1 or Crank:1.</param>
    /// <returns>An index into the document's GameObjects.</returns>
    /// <exception cref="ArgumentException">None has it, or several have the name: the message says which.</exception>
    public int GameObjectNamed(string idOrName)
    {
        int found = _names.GameObject(idOrName ?? throw new ArgumentNullException(nameof(idOrName)), out IReadOnlyList<string> several);
        if (found >= 0)
            return found;
        throw new ArgumentException(
            several.Count > 0
                ? $"{idOrName}: say which: {SceneNames.List(several)}."
                : $"{idOrName}: no GameObject has this id, nor one alone this name; bodies: {SceneNames.There(Array.ConvertAll(GameObjects, i => Scene.Document.GameObjects[i].Id))}",
            nameof(idOrName));
    }

    /// <summary>The coupling with an id: what the source calls it.</summary>
    /// <param name="id">A <see cref="Coupling.Id"/>.</param>
    /// <returns>The coupling as the mechanism holds it.</returns>
    /// <exception cref="ArgumentException">None has it, or several have: the message says which there are.</exception>
    public Coupling Coupling(string id)
    {
        if (id is null)
            throw new ArgumentNullException(nameof(id));
        Coupling[] found = Scene.Document.Couplings.Where(coupling => coupling.Id == id).ToArray();
        string[] there = Scene.Document.Couplings.Select(coupling => coupling.Id).OfType<string>().Distinct().ToArray();
        return found.Length switch
        {
            1 => found[0],
            0 => throw new ArgumentException($"{id}: no coupling has this id; {SceneNames.There(there)}", nameof(id)),
            _ => throw new ArgumentException($"{id}: {found.Length} couplings have this id.", nameof(id)),
        };
    }

    /// <summary>The body that moves a GameObject, or World.</summary>
    internal int BodyOf(int gameObject) => (uint)gameObject < (uint)_bodyOf.Length
        ? _bodyOf[gameObject]
        : throw new ArgumentOutOfRangeException(nameof(gameObject), $"The scene has {_bodyOf.Length} objects.");

    /// <summary>Where the body that moves a GameObject stands when the GameObject stands at a pose.</summary>
    internal Pose PoseOfBody(int gameObject, in Pose world) => world * _locals[gameObject].Inverse();

    /// <summary>A point of a GameObject in the frame of the body that moves it.</summary>
    internal Vector3d PointInBody(int gameObject, Vector3d point) => _locals[gameObject].Point(point);

    internal Pose PoseOfGameObject(int gameObject, Pose[] poses)
    {
        int body = BodyOf(gameObject);
        return body < 0 ? _locals[gameObject] : poses[body] * _locals[gameObject];
    }

    /// <summary>How many bodies, joints and couplings it has, and its coordinates.</summary>
    public override string ToString() => $"mechanism of {Invariant.Counted(GameObjects.Length, "body", "bodies")}, {Invariant.Counted(JointPlaces.Length, "joint")}, {Invariant.Counted(Couplings.Length, "coupling")}; coordinates: {SceneNames.There(Array.ConvertAll(_coordinates, c => c.Name))}";
}
