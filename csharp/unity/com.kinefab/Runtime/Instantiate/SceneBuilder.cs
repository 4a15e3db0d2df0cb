using System;
using System.Collections.Generic;
using Kinefab.Validation;
using UnityEngine;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>
    /// Makes Unity's objects of a scene: hierarchy, bodies, joints, colliders, meshes, materials and clips. The numbers go over as they
    /// are, since the file is in Unity's frame and units already.
    /// </summary>
    internal sealed class SceneBuilder
    {
        private readonly ValidScene scene;
        private readonly Doc.SceneDocument document;
        private readonly KinefabSettings settings;
        private readonly List<KinefabFinding> findings;
        private readonly string[] names;
        private readonly Dictionary<(int Object, int Component), Component> made = new Dictionary<(int Object, int Component), Component>();
        private readonly List<AnimationClip> clips = new List<AnimationClip>();
        private GameObject root;
        private Placement placement;

        /// <param name="scene">What is made.</param>
        /// <param name="settings">How.</param>
        /// <param name="findings">Gets what Unity or this project has no place for.</param>
        /// <param name="replaced">See <see cref="Looks"/>; null: nothing is.</param>
        internal SceneBuilder(ValidScene scene, KinefabSettings settings, List<KinefabFinding> findings, Func<int, Material> replaced = null)
        {
            this.scene = scene;
            this.settings = settings;
            this.findings = findings;
            document = scene.Document;
            Looks = new Looks(scene, settings, findings, replaced);
            Objects = new GameObject[document.GameObjects.Count];
            names = ObjectNames.Of(document);
        }

        /// <summary>In the order of the file, so that its indices hold.</summary>
        internal GameObject[] Objects { get; }

        /// <summary>What they show.</summary>
        internal Looks Looks { get; }

        /// <summary>In the order of the file.</summary>
        internal IReadOnlyList<AnimationClip> AnimationClips => clips;

        /// <summary>Called with the share of the work that is done, 0 to 1 and rising; null: nobody is.</summary>
        internal Action<float> Progress { get; set; }

        /// <summary>
        /// Makes everything; nothing of it is left where that fails. The object returned is the file's only root, or one above its roots: where they are several, where the root
        /// does not stand at the origin, as the user places the mechanism by it, or where it moves.
        /// </summary>
        /// <param name="name">Of an object above the file's roots.</param>
        /// <param name="parent">Where it goes; null: nowhere.</param>
        internal GameObject Build(string name, Transform parent)
        {
            try
            {
                Make(name, parent);
                return root;
            }
            catch
            {
                Clear();
                throw;
            }
        }

        /// <summary>Leaves the component that moves the whole, where the scene has a body: after <see cref="Build"/>.</summary>
        internal void Move(KinefabSource source)
        {
            for (int i = 0; i < Objects.Length; i++)
            {
                if (scene.Body(i) == null)
                {
                    continue;
                }

                KinefabMechanism mechanism = root.AddComponent<KinefabMechanism>();
                mechanism.Bind(source, Array.ConvertAll(Objects, part => part.transform));
                if (mechanism.Freedoms.Count == 0)
                {
                    findings.Add(KinefabFinding.Of("UNITY_NOTHING_MOVES", ""));
                }

                return;
            }
        }

        /// <summary>Removes all that was made.</summary>
        internal void Clear()
        {
            // Objects that have not found their parent yet, too.
            foreach (GameObject made in Objects)
            {
                UnityEngine.Object.DestroyImmediate(made);
            }

            UnityEngine.Object.DestroyImmediate(root);
            foreach (IEnumerable<UnityEngine.Object> kind in new IEnumerable<UnityEngine.Object>[] { Looks.Meshes, Looks.Materials, Looks.Textures.Values, Looks.PhysicsMaterials, clips })
            {
                foreach (UnityEngine.Object made in kind)
                {
                    UnityEngine.Object.DestroyImmediate(made);
                }
            }
        }

        private void Make(string name, Transform parent)
        {
            bool hasOwnRoot = NeedsRoot();
            if (hasOwnRoot)
            {
                root = new GameObject(name);
            }

            var words = new LayersAndTags(findings);

            // Every pose comes before any body: PhysX takes a body's pose when the body is made. And nothing acts before all is there.
            for (int i = 0; i < Objects.Length; i++)
            {
                Doc.GameObject from = document.GameObjects[i];
                Objects[i] = new GameObject(names[i]);
                root = root != null ? root : Objects[i];
                root.SetActive(false);
                Transform above = from.Parent is int index ? Objects[index].transform : hasOwnRoot ? root.transform : null;
                Place(Objects[i].transform, above, from.Transform);
                words.Set(Objects[i], from);
            }

            words.Tell();
            if (root == null)
            {
                root = new GameObject(name);
                root.SetActive(false);
            }

            root.transform.SetParent(parent, worldPositionStays: false);
            placement = new Placement(parent, findings);
            if (settings.physics != KinefabPhysics.None)
            {
                Bodies();
            }

            Components();
            if (settings.physics != KinefabPhysics.None)
            {
                new CouplingFields(scene, Objects, made, placement.Scale, findings).Make();
            }

            Animate();
            for (int i = 0; i < Objects.Length; i++)
            {
                if (Objects[i] != root)
                {
                    Objects[i].SetActive(document.GameObjects[i].Active);
                }
            }

            // Last, when all joints know their bodies.
            root.SetActive(hasOwnRoot || Objects.Length == 0 || document.GameObjects[0].Active);
        }

        private bool NeedsRoot()
        {
            int roots = 0;
            foreach (Doc.GameObject from in document.GameObjects)
            {
                roots += from.Parent == null ? 1 : 0;
            }

            if (roots != 1)
            {
                return true;
            }

            Doc.GameObject first = document.GameObjects[0];
            bool moves = scene.Body(0) is Doc.Rigidbody body && !body.IsKinematic;
            return moves || first.Transform != Doc.Transform.Default;
        }

        private static void Place(Transform to, Transform parent, Doc.Transform from)
        {
            to.SetParent(parent, worldPositionStays: false);
            to.localPosition = Numbers.Vector(from.LocalPosition);
            to.localRotation = Numbers.Rotation(from.LocalRotation);
            to.localScale = Numbers.Vector(from.LocalScale);
        }

        // Every body comes before any joint: a joint's connected body may stand further down.
        private void Bodies()
        {
            for (int i = 0; i < Objects.Length; i++)
            {
                IReadOnlyList<Doc.Component> components = document.GameObjects[i].Components;
                for (int c = 0; c < components.Count; c++)
                {
                    Doc.Component component = components[c];
                    if (component is Doc.ArticulationBody link && settings.physics != KinefabPhysics.Joints)
                    {
                        var body = Objects[i].AddComponent<ArticulationBody>();
                        BodyFields.Set(body, link, document.Physics, placement, scene.IsRootLink(i));
                        made[(i, c)] = body;
                    }
                    else if (component is Doc.Rigidbody || component is Doc.ArticulationBody)
                    {
                        BodyFields.Set(Objects[i].AddComponent<Rigidbody>(), scene.Body(i), document.Physics, placement);
                    }
                }
            }
        }

        private void Components()
        {
            const int Told = 256;
            var joints = new JointFields(Objects, placement, findings);
            for (int i = 0; i < Objects.Length; i++)
            {
                IReadOnlyList<Doc.Component> components = document.GameObjects[i].Components;
                for (int c = 0; c < components.Count; c++)
                {
                    if (!(components[c] is Doc.ArticulationBody))
                    {
                        Add(components[c], i, c, joints);
                    }
                    else if (settings.physics == KinefabPhysics.Joints && !scene.IsRootLink(i))
                    {
                        // What keeps a link on the one above it, as a joint.
                        Add(LinkAsJoint.Of(scene, i, c, findings), i, c, joints);
                    }
                }

                if (i % Told == 0)
                {
                    Progress?.Invoke((float)i / Objects.Length);
                }
            }

            Progress?.Invoke(1);
        }

        private void Add(Doc.Component component, int index, int place, JointFields joints)
        {
            GameObject to = Objects[index];
            string id = document.GameObjects[index].Id;
            switch (component)
            {
                case Doc.MeshFilter filter:
                    to.AddComponent<MeshFilter>().sharedMesh = Looks.Mesh(filter.Mesh);
                    break;
                case Doc.MeshRenderer renderer:
                    Set(to.AddComponent<MeshRenderer>(), renderer);
                    break;
                case Doc.Collider collider when !settings.colliders:
                    break;
                case Doc.Collider collider when ColliderFields.IsEmpty(collider):
                    findings.Add(KinefabFinding.Of("COLLIDER_EMPTY", id, ("object", id)));
                    break;
                case Doc.Collider collider:
                    ColliderFields.Add(collider, to, Looks);
                    break;
                case Doc.Joint _ when settings.physics == KinefabPhysics.None:
                    break;
                case Doc.Joint { Enabled: false } off:
                    findings.Add(KinefabFinding.Of("JOINT_DISABLED_DROPPED", id, ("joint", off.Id ?? id), ("target", "Unity")));
                    break;
                case Doc.HingeJoint hinge:
                    joints.Set(Made<HingeJoint>(index, place), hinge);
                    break;
                case Doc.ConfigurableJoint configurable:
                    joints.Set(Made<ConfigurableJoint>(index, place), configurable);
                    break;
                case Doc.FixedJoint rigid:
                    joints.Set(Made<FixedJoint>(index, place), rigid);
                    break;
            }
        }

        private T Made<T>(int index, int place) where T : Joint
        {
            T joint = Objects[index].AddComponent<T>();
            made[(index, place)] = joint;
            return joint;
        }

        private void Set(MeshRenderer to, Doc.MeshRenderer from)
        {
            var materials = new Material[from.Materials.Count];
            for (int i = 0; i < materials.Length; i++)
            {
                materials[i] = Looks.Material(from.Materials[i]);
            }

            to.sharedMaterials = materials;
            to.enabled = from.Enabled;
        }

        private void Animate()
        {
            if (document.Animations.Count == 0)
            {
                return;
            }

            // Of several of one name the first in the file keeps it.
            var plain = new string[document.Animations.Count];
            var order = new string[plain.Length];
            for (int i = 0; i < plain.Length; i++)
            {
                plain[i] = ObjectNames.Plain(document.Animations[i].Name);
                order[i] = i.ToString("D9", System.Globalization.CultureInfo.InvariantCulture);
            }

            string[] told = ObjectNames.Unique(plain, order);
            var animation = root.AddComponent<Animation>();
            for (int i = 0; i < told.Length; i++)
            {
                clips.Add(Clips.Make(document.Animations[i], told[i], Path));
                animation.AddClip(clips[i], told[i]);
            }

            animation.clip = clips[0];

            // What the solver moves too no clip moves unasked.
            animation.playAutomatically = !MovedByForces();
#if UNITY_2023_1_OR_NEWER
            animation.updateMode = AnimationUpdateMode.Fixed;
#else
            animation.animatePhysics = true;
#endif
        }

        private string Path(int index)
        {
            string path = "";
            for (Transform at = Objects[index].transform; at != root.transform; at = at.parent)
            {
                path = path.Length == 0 ? at.name : $"{at.name}/{path}";
            }

            return path;
        }

        private bool MovedByForces()
        {
            if (settings.physics == KinefabPhysics.None)
            {
                return false;
            }

            foreach (Doc.AnimationClip clip in document.Animations)
            {
                foreach (Doc.AnimationTrack track in clip.Tracks)
                {
                    if (scene.BodyOf(track.GameObject) is int body && !scene.Body(body).IsKinematic)
                    {
                        return true;
                    }
                }
            }

            return false;
        }
    }
}
