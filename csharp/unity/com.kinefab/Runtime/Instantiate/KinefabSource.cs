using System.Collections.Generic;
using Kinefab.Diagnostics;
using Kinefab.Validation;
using UnityEngine;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>What a mechanism was made of: the text of its file, without the numbers of meshes, and what was found about it.</summary>
    public sealed class KinefabSource : ScriptableObject
    {
        [SerializeField, HideInInspector]
        private byte[] text = new byte[0];

        [SerializeField, HideInInspector]
        private string ground = "";

        [SerializeField, HideInInspector]
        private KinefabPhysics physics = KinefabPhysics.AsExported;

        [SerializeField, HideInInspector]
        private string version = "";

        [SerializeField]
        private KinefabFinding[] findings = new KinefabFinding[0];

        /// <summary>What was found when it was made: of the file, and what it lost on its way out of its source.</summary>
        public IReadOnlyList<KinefabFinding> Findings => findings;

        /// <summary>Sets the project to what the mechanism was made for: gravity, time step, solver. A prefab cannot.</summary>
        public void ApplyProjectSettings()
        {
            Doc.Physics from = Load().Document.Physics;
            Physics.gravity = Numbers.Vector(from.Gravity);
            Physics.bounceThreshold = (float)from.BounceThreshold;
            Physics.defaultSolverIterations = from.SolverIterations;
            Physics.defaultSolverVelocityIterations = from.SolverVelocityIterations;
            Physics.defaultMaxAngularSpeed = (float)from.DefaultMaxAngularSpeed;
            Time.fixedDeltaTime = (float)from.FixedTimestep;
        }

        /// <param name="text">The file.</param>
        /// <param name="settings">What was made of it.</param>
        internal static KinefabSource Of(byte[] text, KinefabSettings settings)
        {
            KinefabSource source = CreateInstance<KinefabSource>();
            source.name = "Source";
            source.text = WithoutBuffers(text);
            source.ground = settings.ground;
            source.physics = settings.physics;
            source.version = $"{Digest.Of(source.text)} {settings.physics} {settings.ground}";
            return source;
        }

        // A file that holds its buffers (SPEC, section 1) begins with a head of 12 bytes, then comes the text with its length before it.
        private static byte[] WithoutBuffers(byte[] file)
        {
            const int Head = 12, ChunkHead = 8;
            if (file.Length < Head + ChunkHead || System.Text.Encoding.ASCII.GetString(file, 0, 4) != "KFAB")
            {
                return file;
            }

            int length = System.BitConverter.ToInt32(file, Head);
            bool isWhole = length >= 0 && length <= file.Length - Head - ChunkHead;
            return isWhole ? new System.ReadOnlySpan<byte>(file, Head + ChunkHead, length).ToArray() : file;
        }

        /// <summary>Another one where the mechanism may be another.</summary>
        internal string Version => version;

        internal void Tell(List<KinefabFinding> found) => findings = found.ToArray();

        /// <summary>The scene without looks; objects and components stand where the scene has them that was made.</summary>
        /// <exception cref="SceneFormatException">The text is none of a scene.</exception>
        internal ValidScene Load()
        {
            Doc.SceneReading reading = Doc.SceneFile.Parse(text);
            if (reading.Document == null)
            {
                throw new SceneFormatException(reading.Report);
            }

            SceneValidation validation = SceneValidator.Validate(Bare(reading.Document));
            ValidScene scene = validation.Scene ?? throw new SceneFormatException(validation.Report);
            return Articulation.Apply(Ground.Apply(scene, ground, null), physics, null);
        }

        /// <summary>What the file was exported with: 12 Rigidbodies and 14 joints.</summary>
        internal string DescribePhysics() => Doc.SceneFile.Parse(text).Document is Doc.SceneDocument document ? PhysicsOfFile.Describe(document) : "";

        /// <summary>What <see cref="ApplyProjectSettings"/> sets: gravity (0, -9.81, 0), time step 0.02 s, 6 and 1 solver iterations.</summary>
        internal string DescribeWorld()
        {
            Doc.Physics from = Load().Document.Physics;
            return System.FormattableString.Invariant(
                $"gravity ({from.Gravity.X}, {from.Gravity.Y}, {from.Gravity.Z}), time step {from.FixedTimestep} s, {from.SolverIterations} and {from.SolverVelocityIterations} solver iterations");
        }

        private static Doc.SceneDocument Bare(Doc.SceneDocument document)
        {
            var objects = new List<Doc.GameObject>(document.GameObjects.Count);
            foreach (Doc.GameObject entry in document.GameObjects)
            {
                var components = new List<Doc.Component>(entry.Components.Count);
                foreach (Doc.Component component in entry.Components)
                {
                    bool isLook = component is Doc.MeshFilter || component is Doc.MeshRenderer || component is Doc.MeshCollider;

                    // Something harmless keeps its place: couplings refer to joints by theirs.
                    components.Add(isLook ? new Doc.BoxCollider { IsTrigger = true } : component);
                }

                objects.Add(entry with { Components = components });
            }

            return document with
            {
                Buffers = new Doc.SceneBuffer[0],
                Meshes = new Doc.Mesh[0],
                Materials = new Doc.Material[0],
                Images = new Doc.Image[0],
                Animations = new Doc.AnimationClip[0],
                GameObjects = objects,
            };
        }
    }
}
