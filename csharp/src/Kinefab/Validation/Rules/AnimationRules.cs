using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Json;

namespace Kinefab.Validation;

/// <summary>Animations.</summary>
internal static class AnimationRules
{
    internal static void Check(AnimationClip clip, int gameObjectCount, in Place at)
    {
        Times(clip, at);
        for (int i = 0; i < clip.Tracks.Count; i++)
        {
            string field = "tracks/" + Invariant.Text(i);
            AnimationTrack track = clip.Tracks[i];
            NumberRules.Reference(at, field + "/gameObject", track.GameObject, "gameObjects", gameObjectCount);
            KeyCount(track.LocalPosition.Count, clip.Times.Count, field + "/localPosition", at);
            KeyCount(track.LocalRotation.Count, clip.Times.Count, field + "/localRotation", at);
            Keys(track, field, at);
        }
    }

    private static void Keys(AnimationTrack track, string field, in Place at)
    {
        for (int key = 0; key < track.LocalPosition.Count; key++)
        {
            if (!track.LocalPosition[key].IsFinite)
                NumberRules.Finite(at, field + "/localPosition/" + Invariant.Text(key), track.LocalPosition[key]);
        }

        for (int key = 0; key < track.LocalRotation.Count; key++)
        {
            if (!NumberRules.IsUnit(track.LocalRotation[key]))
                NumberRules.Unit(at, field + "/localRotation/" + Invariant.Text(key), track.LocalRotation[key]);
        }
    }

    private static void Times(AnimationClip clip, in Place at)
    {
        for (int i = 0; i < clip.Times.Count; i++)
        {
            if (!Numerics.Finite.Is(clip.Times[i]))
            {
                NumberRules.Finite(at, "times/" + Invariant.Text(i), clip.Times[i]);
                return;
            }
        }

        for (int i = 1; i < clip.Times.Count; i++)
        {
            if (!(clip.Times[i] > clip.Times[i - 1]))
            {
                at.Report("times/" + Invariant.Text(i), DiagnosticCodes.AnimationTimesNotRising);
                return;
            }
        }
    }

    private static void KeyCount(int keys, int times, string field, in Place at)
    {
        if (keys > 0 && keys != times)
            at.Report(field, DiagnosticCodes.AnimationKeyCount, ("keys", Invariant.Text(keys)), ("times", Invariant.Text(times)));
    }
}
