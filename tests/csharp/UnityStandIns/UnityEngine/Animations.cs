using System;
using System.Collections.Generic;

namespace UnityEngine
{
    public enum WrapMode
    {
        Default = 0,
        Once = 1,
        Loop = 2,
        PingPong = 4,
        ClampForever = 8,
    }

    [Serializable]
    public struct Keyframe
    {
        public Keyframe(float time, float value, float inTangent, float outTangent)
        {
            (this.time, this.value, this.inTangent, this.outTangent) = (time, value, inTangent, outTangent);
        }

        public float time { get; set; }

        public float value { get; set; }

        public float inTangent { get; set; }

        public float outTangent { get; set; }
    }

    public class AnimationCurve
    {
        public AnimationCurve(params Keyframe[] keys)
        {
            for (int i = 1; i < keys.Length; i++)
            {
                if (!(keys[i].time > keys[i - 1].time))
                {
                    throw new ArgumentException("Unity drops a key at a time that it has.");
                }
            }

            this.keys = keys;
        }

        public Keyframe[] keys { get; set; }
    }

    public sealed class AnimationClip : Object
    {
        /// <summary>By path, component and property.</summary>
        internal readonly Dictionary<(string Path, Type Type, string Property), AnimationCurve> Curves = new Dictionary<(string, Type, string), AnimationCurve>();

        public bool legacy { get; set; }

        public WrapMode wrapMode { get; set; }

        public float frameRate { get; set; } = 60;

        public void SetCurve(string relativePath, Type type, string propertyName, AnimationCurve curve)
        {
            if (!legacy)
            {
                throw new InvalidOperationException("Only a legacy clip takes curves while the game runs.");
            }

            Curves[(relativePath, type, propertyName)] = curve;
        }
    }

    public sealed class Animation : Behaviour
    {
        internal readonly List<AnimationClip> Clips = new List<AnimationClip>();

        public AnimationClip clip { get; set; }

        public bool playAutomatically { get; set; } = true;

#if UNITY_2023_1_OR_NEWER
        public AnimationUpdateMode updateMode { get; set; }
#else
        public bool animatePhysics { get; set; }
#endif

        public int GetClipCount() => Clips.Count;

        public void AddClip(AnimationClip clip, string newName)
        {
            if (Clips.Exists(c => c.name == newName && !ReferenceEquals(c, clip)))
            {
                throw new ArgumentException("Unity replaces a clip of that name.");
            }

            Clips.Add(clip);
        }
    }

#if UNITY_2023_1_OR_NEWER
    public enum AnimationUpdateMode
    {
        Normal = 0,
        Fixed = 1,
    }
#endif
}
