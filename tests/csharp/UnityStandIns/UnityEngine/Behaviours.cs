using System;
using System.Collections.Generic;
using System.Reflection;

namespace UnityEngine
{
    public class Behaviour : Component
    {
        private bool _enabled = true;

        public bool enabled
        {
            get => _enabled;
            set
            {
                _enabled = value;
                Player.Renew(gameObject);
            }
        }

        public bool isActiveAndEnabled => enabled && gameObject.activeInHierarchy;
    }

    public class MonoBehaviour : Behaviour
    {
        internal bool IsAwake { get; set; }

        internal bool IsOn { get; set; }

        internal bool IsStarted { get; set; }

        internal override void Ending()
        {
            if (IsOn)
            {
                IsOn = false;
                Calls.Of(this, "OnDisable");
            }

            if (IsAwake)
            {
                Calls.Of(this, "OnDestroy");
            }

            base.Ending();
        }
    }

    [AttributeUsage(AttributeTargets.Class)]
    public sealed class ExecuteAlways : Attribute
    {
    }

    [AttributeUsage(AttributeTargets.Class)]
    public sealed class DisallowMultipleComponent : Attribute
    {
    }

    [AttributeUsage(AttributeTargets.Class, AllowMultiple = true)]
    public sealed class RequireComponent : Attribute
    {
        public RequireComponent(Type requiredComponent) => m_Type0 = requiredComponent;

        public Type m_Type0;
    }

    [AttributeUsage(AttributeTargets.Class)]
    public sealed class AddComponentMenu : Attribute
    {
        public AddComponentMenu(string menuName) => componentMenu = menuName;

        public string componentMenu { get; }
    }

    [AttributeUsage(AttributeTargets.Class)]
    public sealed class DefaultExecutionOrder : Attribute
    {
        public DefaultExecutionOrder(int order) => this.order = order;

        public int order { get; }
    }

    [AttributeUsage(AttributeTargets.Class)]
    public sealed class HelpURLAttribute : Attribute
    {
        public HelpURLAttribute(string url) => URL = url;

        public string URL { get; }
    }

    [AttributeUsage(AttributeTargets.Field)]
    public sealed class SerializeField : Attribute
    {
    }

    [AttributeUsage(AttributeTargets.Field)]
    public sealed class HideInInspector : Attribute
    {
    }

    [AttributeUsage(AttributeTargets.Field)]
    public sealed class TooltipAttribute : Attribute
    {
        public TooltipAttribute(string tooltip) => this.tooltip = tooltip;

        public readonly string tooltip;
    }

    /// <summary>Unity's messages: methods of any access, found by name.</summary>
    internal static class Calls
    {
        // BindingFlags.DoNotWrapExceptions, which netstandard2.0 has no name for.
        private const BindingFlags Unwrapped = (BindingFlags)0x02000000;

        public static void Of(object on, string message)
        {
            for (Type type = on.GetType(); type != null && type != typeof(object); type = type.BaseType)
            {
                MethodInfo method = type.GetMethod(message, BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic | BindingFlags.DeclaredOnly, null, Type.EmptyTypes, null);
                if (method != null)
                {
                    method.Invoke(on, Unwrapped, null, null, null);
                    return;
                }
            }
        }
    }

    /// <summary>Stands for the player's loop: tests step it.</summary>
    internal static class Player
    {
        private static readonly List<MonoBehaviour> Live = new List<MonoBehaviour>();

        /// <summary>Enters or leaves play mode; components that are there wake as they would in a scene that is loaded.</summary>
        public static void Play(bool isPlaying) => Application.isPlaying = isPlaying;

        /// <summary>One frame: FixedUpdate unless time stands still, Update, LateUpdate.</summary>
        public static void Frame()
        {
            Each(b =>
            {
                if (!b.IsStarted)
                {
                    b.IsStarted = true;
                    Calls.Of(b, "Start");
                }
            });
            if (Time.timeScale > 0)
            {
                Each(b => Calls.Of(b, "FixedUpdate"));
                Physics.SyncTransforms();
                Time.time += Time.fixedDeltaTime * Time.timeScale;
            }

            Each(b => Calls.Of(b, "Update"));
            Each(b => Calls.Of(b, "LateUpdate"));
        }

        /// <summary>As scripts are compiled anew: what is not serialized is lost, Awake and Start do not come again.</summary>
        public static void ReloadDomain()
        {
            MonoBehaviour[] all = Live.ToArray();
            foreach (MonoBehaviour behaviour in all)
            {
                if (behaviour.IsOn)
                {
                    Calls.Of(behaviour, "OnDisable");
                }
            }

            foreach (MonoBehaviour behaviour in all)
            {
                Copies.Forget(behaviour);
            }

            foreach (MonoBehaviour behaviour in all)
            {
                if (behaviour.IsOn)
                {
                    Calls.Of(behaviour, "OnEnable");
                }
            }
        }

        /// <summary>Wakes, enables and disables what has changed at an object and below it.</summary>
        internal static void Renew(GameObject of)
        {
            if (!Copies.IsCopying)
            {
                Bodies(of);
                Joints(of);
                Scripts(of);
            }
        }

        private static void Bodies(GameObject of)
        {
            if (of.GetComponent<Rigidbody>() is Rigidbody body && (body.InPhysics != null) != of.activeInHierarchy)
            {
                body.Sync();
            }

            Below(of, Bodies);
        }

        private static void Joints(GameObject of)
        {
            foreach (Joint joint in of.GetComponents<Joint>())
            {
                joint.Renew();
            }

            Below(of, Joints);
        }

        private static void Scripts(GameObject of)
        {
            foreach (Component component in of.Components.ToArray())
            {
                if (component is MonoBehaviour behaviour)
                {
                    Renew(behaviour);
                }
            }

            Below(of, Scripts);
        }

        private static void Below(GameObject of, Action<GameObject> call)
        {
            if (of.transform != null)
            {
                foreach (Transform child in of.transform.Children.ToArray())
                {
                    call(child.gameObject);
                }
            }
        }

        internal static void Forget(GameObject of) => Live.RemoveAll(b => b.IsDestroyed);

        private static void Renew(MonoBehaviour behaviour)
        {
            bool runs = Application.isPlaying || behaviour.GetType().IsDefined(typeof(ExecuteAlways), inherit: true);
            if (!runs)
            {
                return;
            }

            if (behaviour.gameObject.activeInHierarchy && !behaviour.IsAwake)
            {
                behaviour.IsAwake = true;
                Live.Add(behaviour);
                Calls.Of(behaviour, "Awake");
            }

            bool isOn = behaviour.isActiveAndEnabled;
            if (isOn != behaviour.IsOn)
            {
                behaviour.IsOn = isOn;
                Calls.Of(behaviour, isOn ? "OnEnable" : "OnDisable");
            }
        }

        private static void Each(Action<MonoBehaviour> call)
        {
            Live.RemoveAll(b => b.IsDestroyed);
            foreach (MonoBehaviour behaviour in Live.ToArray())
            {
                if (!behaviour.IsDestroyed && behaviour.isActiveAndEnabled)
                {
                    call(behaviour);
                }
            }
        }
    }
}
