using System;
using System.Collections.Generic;

namespace UnityEngine
{
    [Flags]
    public enum HideFlags
    {
        None = 0,
        HideInHierarchy = 1,
        HideInInspector = 2,
        DontSaveInEditor = 4,
        NotEditable = 8,
        DontSave = 52,
        HideAndDontSave = 61,
    }

    /// <summary>Is null for ==, !=, and as a bool once it is destroyed.</summary>
    public class Object
    {
        internal bool IsDestroyed { get; private set; }

        public string name { get; set; } = "";

        public HideFlags hideFlags { get; set; }

        public static void Destroy(Object obj) => DestroyImmediate(obj);

        public static void DestroyImmediate(Object obj)
        {
            if (obj == null)
            {
                return;
            }

            obj.Ending();
            obj.IsDestroyed = true;
        }

        public static T Instantiate<T>(T original) where T : Object => Instantiate(original, null);

        public static T Instantiate<T>(T original, Transform parent) where T : Object => (T)Copies.Of(original, parent);

        public override bool Equals(object other) => other is Object same && this == same;

        public override int GetHashCode() => base.GetHashCode();

        public override string ToString() => $"{name} ({GetType().FullName})";

        public static bool operator ==(Object a, Object b)
        {
            bool noA = a is null || a.IsDestroyed, noB = b is null || b.IsDestroyed;
            return noA || noB ? noA && noB : ReferenceEquals(a, b);
        }

        public static bool operator !=(Object a, Object b) => !(a == b);

        public static implicit operator bool(Object exists) => exists != null;

        /// <summary>What else goes with it.</summary>
        internal virtual void Ending()
        {
        }
    }

    public class ScriptableObject : Object
    {
        public static T CreateInstance<T>() where T : ScriptableObject
        {
            var made = Activator.CreateInstance<T>();
            Calls.Of(made, "OnEnable");
            return made;
        }

        internal override void Ending()
        {
            Calls.Of(this, "OnDisable");
            Calls.Of(this, "OnDestroy");
        }
    }

    public class TextAsset : Object
    {
        private readonly string _text;

        public TextAsset(string text) => _text = text;

        public string text => _text;
    }

    public class Component : Object
    {
        public GameObject gameObject { get; internal set; }

        public Transform transform => gameObject.transform;

        public T GetComponent<T>() => gameObject.GetComponent<T>();

        public bool TryGetComponent<T>(out T component) => gameObject.TryGetComponent(out component);

        public T[] GetComponents<T>() => gameObject.GetComponents<T>();

        public void GetComponents<T>(List<T> results) => gameObject.GetComponents(results);

        public void GetComponentsInChildren<T>(List<T> results) => gameObject.GetComponentsInChildren(includeInactive: false, results);

        public void GetComponentsInChildren<T>(bool includeInactive, List<T> results) => gameObject.GetComponentsInChildren(includeInactive, results);

        public T GetComponentInParent<T>() => gameObject.GetComponentInParent<T>();

        public T[] GetComponentsInChildren<T>(bool includeInactive = false) => gameObject.GetComponentsInChildren<T>(includeInactive);

        internal override void Ending() => gameObject.Components.Remove(this);
    }

    public sealed class GameObject : Object
    {
        /// <summary>The project's.</summary>
        internal static readonly HashSet<string> Tags = new HashSet<string> { "Untagged", "Respawn", "Finish", "EditorOnly", "MainCamera", "Player", "GameController" };

        internal readonly List<Component> Components = new List<Component>();
        private string _tag = "Untagged";

        public GameObject()
            : this("New Game Object")
        {
        }

        public GameObject(string name)
        {
            this.name = name;
            transform = AddComponent<Transform>();
        }

        public Transform transform { get; }

        public int layer { get; set; }

        /// <summary>Refuses what the project has not, as Unity does.</summary>
        public string tag
        {
            get => _tag;
            set => _tag = Tags.Contains(value) ? value : throw new UnityException($"Tag: {value} is not defined.");
        }

        public bool isStatic { get; set; }

        public bool activeSelf { get; private set; } = true;

        public bool activeInHierarchy => activeSelf && (transform == null || transform.parent == null || transform.parent.gameObject.activeInHierarchy);

        public void SetActive(bool value)
        {
            if (value == activeSelf)
            {
                return;
            }

            activeSelf = value;
            Player.Renew(this);
        }

        public T AddComponent<T>() where T : Component => (T)AddComponent(typeof(T));

        public Component AddComponent(Type type)
        {
            if (typeof(Joint).IsAssignableFrom(type) && GetComponent<Rigidbody>() == null && !Articulated())
            {
                throw new InvalidOperationException("Unity would add a Rigidbody of its own.");
            }

            var component = (Component)Activator.CreateInstance(type, nonPublic: true);
            component.gameObject = this;
            component.name = name;
            Components.Add(component);
            (component as Joint)?.Made();
            if (component is MonoBehaviour)
            {
                Player.Renew(this);
            }

            return component;
        }

        public T GetComponent<T>() => (T)(object)Components.Find(c => c is T);

        public bool TryGetComponent<T>(out T component)
        {
            component = GetComponent<T>();
            return component is Object found && found != null;
        }

        public T[] GetComponents<T>() => Components.FindAll(c => c is T).ConvertAll(c => (T)(object)c).ToArray();

        public void GetComponents<T>(List<T> results)
        {
            results.Clear();
            results.AddRange(GetComponents<T>());
        }

        public T GetComponentInParent<T>()
        {
            for (Transform at = transform; at != null; at = at.parent)
            {
                if (at.gameObject.GetComponent<T>() is T found)
                {
                    return found;
                }
            }

            return default;
        }

        public T GetComponentInChildren<T>(bool includeInactive = false)
        {
            T[] found = GetComponentsInChildren<T>(includeInactive);
            return found.Length > 0 ? found[0] : default;
        }

        public T[] GetComponentsInChildren<T>(bool includeInactive = false)
        {
            var found = new List<T>();
            Collect(this, includeInactive, found);
            return found.ToArray();
        }

        public void GetComponentsInChildren<T>(bool includeInactive, List<T> results)
        {
            results.Clear();
            Collect(this, includeInactive, results);
        }

        internal override void Ending()
        {
            foreach (Transform child in transform.Children.ToArray())
            {
                DestroyImmediate(child.gameObject);
            }

            foreach (Component component in Components.ToArray())
            {
                if (component != transform)
                {
                    DestroyImmediate(component);
                }
            }

            transform.Leave();
            DestroyImmediate(transform);
            Player.Forget(this);
        }

        private static void Collect<T>(GameObject of, bool includeInactive, List<T> found)
        {
            if (!includeInactive && !of.activeInHierarchy)
            {
                return;
            }

            found.AddRange(of.GetComponents<T>());
            foreach (Transform child in of.transform.Children)
            {
                Collect(child.gameObject, includeInactive, found);
            }
        }

        private bool Articulated() => Components.Exists(c => c.GetType().Name == "ArticulationBody");
    }

    public struct LayerMask
    {
        /// <summary>The project's; the first eight are Unity's own.</summary>
        internal static readonly List<string> Layers = new List<string> { "Default", "TransparentFX", "Ignore Raycast", "", "Water", "UI", "", "" };

        public static int NameToLayer(string layerName) => layerName.Length == 0 ? -1 : Layers.IndexOf(layerName);
    }

    public class UnityException : SystemException
    {
        public UnityException(string message)
            : base(message)
        {
        }
    }

    public static class Debug
    {
        internal static readonly List<string> Warnings = new List<string>();
        internal static readonly List<string> Errors = new List<string>();

        public static void Log(object message)
        {
        }

        public static void LogWarning(object message) => Warnings.Add(message.ToString());

        public static void LogWarning(object message, Object context) => LogWarning(message);

        public static void LogError(object message) => Errors.Add(message.ToString());

        public static void LogError(object message, Object context) => LogError(message);

        public static void LogException(Exception exception) => Errors.Add(exception.ToString());
    }

    public static class Time
    {
        public static float fixedDeltaTime { get; set; } = 0.02f;

        public static float deltaTime { get; internal set; } = 0.02f;

        public static float timeScale { get; set; } = 1;

        public static float time { get; internal set; }
    }

    public static class Application
    {
        public static bool isPlaying { get; internal set; }

        public static string unityVersion { get; internal set; } = "6000.7.0a1";
    }
}
