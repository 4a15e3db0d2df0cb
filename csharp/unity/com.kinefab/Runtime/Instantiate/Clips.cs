using System;
using System.Collections.Generic;
using Kinefab.Numerics;
using UnityEngine;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>Animation clips of the legacy Animation component, which needs no state machine.</summary>
    internal static class Clips
    {
        // Radians: an arc shorter than this is its chord in the digits of a float.
        private const double Straight = 1e-3;

        /// <param name="from">Linear between its keys.</param>
        /// <param name="name">Each once in a scene.</param>
        /// <param name="path">Of an object by its index, from the object with the Animation, names with slashes between.</param>
        internal static AnimationClip Make(Doc.AnimationClip from, string name, Func<int, string> path)
        {
            var clip = new AnimationClip { name = name, legacy = true, wrapMode = Wrap(from.WrapMode) };
            float[] times = Rising(from.Times);
            foreach (Doc.AnimationTrack track in from.Tracks)
            {
                if (track.LocalPosition.Count > 0)
                {
                    Curves(clip, path(track.GameObject), "localPosition.", times, Values(track.LocalPosition), AlongLine);
                }

                if (track.LocalRotation.Count > 0)
                {
                    Curves(clip, path(track.GameObject), "localRotation.", times, Values(track.LocalRotation), AlongArc);
                }
            }

            return clip;
        }

        private delegate void Way(double[] a, double[] b, double seconds, double[] leaving, double[] arriving);

        private static WrapMode Wrap(Doc.WrapMode mode) =>
            mode == Doc.WrapMode.Loop ? WrapMode.Loop : mode == Doc.WrapMode.PingPong ? WrapMode.PingPong : WrapMode.Once;

        // No two alike: where two keys are a step, the later comes a float after.
        private static float[] Rising(IReadOnlyList<double> times)
        {
            var found = new float[times.Count];
            for (int i = 0; i < found.Length; i++)
            {
                found[i] = (float)times[i];
                if (i > 0 && !(found[i] > found[i - 1]))
                {
                    found[i] = Next(found[i - 1]);
                }
            }

            return found;
        }

        private static float Next(float value) => value == 0 ? float.Epsilon : BitConverter.ToSingle(BitConverter.GetBytes(BitConverter.ToInt32(BitConverter.GetBytes(value), 0) + (value > 0 ? 1 : -1)), 0);

        private static double[][] Values(IReadOnlyList<Vector3d> from)
        {
            var values = new double[from.Count][];
            for (int i = 0; i < values.Length; i++)
            {
                values[i] = new[] { from[i].X, from[i].Y, from[i].Z };
            }

            return values;
        }

        // The same turns by quaternions that do not jump to the other sign, between which Unity would interpolate wrongly.
        private static double[][] Values(IReadOnlyList<Quaterniond> from)
        {
            var values = new double[from.Count][];
            for (int i = 0; i < values.Length; i++)
            {
                Quaterniond q = from[i].Normalized();
                values[i] = new[] { q.X, q.Y, q.Z, q.W };
                if (i > 0 && Dot(values[i - 1], values[i]) < 0)
                {
                    values[i] = Array.ConvertAll(values[i], x => -x);
                }
            }

            return values;
        }

        private static void Curves(AnimationClip clip, string path, string property, float[] times, double[][] values, Way way)
        {
            int width = values[0].Length, count = values.Length;
            var before = new double[count][];
            var after = new double[count][];
            for (int i = 0; i < count; i++)
            {
                before[i] = new double[width];
                after[i] = new double[width];
            }

            for (int i = 0; i + 1 < count; i++)
            {
                way(values[i], values[i + 1], (double)times[i + 1] - times[i], after[i], before[i + 1]);
            }

            // Beyond its ends a clip goes on as it begins and ends.
            before[0] = after[0];
            after[count - 1] = before[count - 1];
            for (int k = 0; k < width; k++)
            {
                var keys = new Keyframe[count];
                for (int i = 0; i < count; i++)
                {
                    keys[i] = new Keyframe(times[i], (float)values[i][k], (float)before[i][k], (float)after[i][k]);
                }

                clip.SetCurve(path, typeof(Transform), property + "xyzw"[k], new AnimationCurve(keys));
            }
        }

        private static void AlongLine(double[] a, double[] b, double seconds, double[] leaving, double[] arriving)
        {
            for (int k = 0; k < a.Length; k++)
            {
                leaving[k] = arriving[k] = (b[k] - a[k]) / seconds;
            }
        }

        // Of the great arc between unit quaternions. Unity makes cubic curves of the four numbers: with the slopes of the chord a
        // turn of 160 degrees would be 6 degrees off on its way.
        private static void AlongArc(double[] a, double[] b, double seconds, double[] leaving, double[] arriving)
        {
            double cosine = Math.Min(1, Dot(a, b)), angle = Math.Acos(cosine);
            if (angle < Straight)
            {
                AlongLine(a, b, seconds, leaving, arriving);
                return;
            }

            double rate = angle / Math.Sin(angle) / seconds;
            for (int k = 0; k < a.Length; k++)
            {
                leaving[k] = rate * (b[k] - cosine * a[k]);
                arriving[k] = rate * (cosine * b[k] - a[k]);
            }
        }

        private static double Dot(double[] a, double[] b)
        {
            double sum = 0;
            for (int k = 0; k < a.Length; k++)
            {
                sum += a[k] * b[k];
            }

            return sum;
        }
    }
}
