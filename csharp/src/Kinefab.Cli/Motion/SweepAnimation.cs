using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Numerics;

namespace Kinefab.Cli.Motion;

/// <summary>Writes a sweep into its scene file as an animation clip; all else in the file stays as it is.</summary>
internal static class SweepAnimation
{
    // A degree or a millimetre a frame would have no common speed; a sweep plays in this time whatever it covers.
    private const double Seconds = 4;

    /// <summary>Adds the clip, or replaces the one of the same name; the report says what kept it from being written.</summary>
    internal static Report Write(string path, Mechanism mechanism, SweepResult sweep, string name)
    {
        SceneDocument document = mechanism.Scene.Document;
        AnimationClip[] animations = [.. document.Animations.Where(clip => clip.Name != name), Clip(mechanism, sweep, name)];
        return TargetFile.Write(path, target => SceneFile.Save(document with { Animations = animations }, target));
    }

    private static AnimationClip Clip(Mechanism mechanism, SweepResult sweep, string name)
    {
        int last = Math.Max(1, sweep.States.Count - 1);
        List<AnimationTrack> tracks = [];
        for (int i = 0; i < mechanism.Scene.Document.GameObjects.Count; i++)
        {
            if (mechanism.Scene.Body(i) is null)
                continue;
            int gameObject = i;
            List<Pose> local = sweep.States.Select(s => Local(mechanism, s, gameObject)).ToList();
            bool moves = local.Any(p => (p.Position - local[0].Position).Length > 1e-9);
            bool turns = local.Any(p => Math.Abs(p.Rotation.X - local[0].Rotation.X) + Math.Abs(p.Rotation.Y - local[0].Rotation.Y) + Math.Abs(p.Rotation.Z - local[0].Rotation.Z) > 1e-9);
            if (!moves && !turns)
                continue;
            tracks.Add(new AnimationTrack
            {
                GameObject = i,
                LocalPosition = moves ? [.. local.Select(p => p.Position)] : [],
                LocalRotation = turns ? [.. Continuous(local)] : [],
            });
        }

        return new AnimationClip
        {
            Name = name,
            Times = [.. sweep.States.Select((_, i) => Seconds * i / last)],
            WrapMode = WrapMode.PingPong,
            Tracks = tracks,
        };
    }

    // Scale acts on the local position alone: bodies are not scaled by moving.
    private static Pose Local(Mechanism mechanism, MechanismState state, int gameObject)
    {
        Pose world = state.Pose(gameObject);
        if (mechanism.Scene.Document.GameObjects[gameObject].Parent is not int parent)
            return world;
        Pose local = state.Pose(parent).Inverse() * world;
        Vector3d scale = mechanism.Scene.WorldTransform(parent).Scale;
        return new Pose(new Vector3d(local.Position.X / scale.X, local.Position.Y / scale.Y, local.Position.Z / scale.Z), local.Rotation);
    }

    // Neighbouring keys on one side of the double cover, so that players that mix components do not swing round.
    private static IEnumerable<Quaterniond> Continuous(List<Pose> poses)
    {
        Quaterniond last = poses[0].Rotation;
        foreach (Pose pose in poses)
        {
            Quaterniond q = pose.Rotation;
            double dot = q.X * last.X + q.Y * last.Y + q.Z * last.Z + q.W * last.W;
            last = dot < 0 ? new Quaterniond(-q.X, -q.Y, -q.Z, -q.W) : q;
            yield return last;
        }
    }
}
