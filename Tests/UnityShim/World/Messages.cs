using System;
using System.Collections.Generic;
using System.Reflection;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityShim
{
    public enum Message
    {
        Awake,
        OnEnable,
        Start,
        FixedUpdate,
        Update,
        LateUpdate,
        OnDisable,
        OnDestroy,
        OnTransformChildrenChanged,
    }

    /// <summary>The message methods of a script type, bound once, so that sending messages allocates nothing.</summary>
    internal sealed class Messages
    {
        private const BindingFlags Anything = BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic;
        private static readonly int Count = Enum.GetValues(typeof(Message)).Length;

        private readonly Action?[] handlers = new Action?[Count];
        private readonly Object script;

        private Messages(Object script)
        {
            this.script = script;
            foreach (Message message in Enum.GetValues(typeof(Message)))
            {
                MethodInfo? method = Find(script.GetType(), message.ToString());
                if (method != null && method.GetParameters().Length == 0)
                {
                    handlers[(int)message] = (Action)Delegate.CreateDelegate(typeof(Action), script, method);
                }
            }
            MethodInfo? filter = Find(script.GetType(), "OnAudioFilterRead");
            AudioFilter = filter == null
                ? null
                : (Action<float[], int>)Delegate.CreateDelegate(typeof(Action<float[], int>), script, filter);
        }

        public Action<float[], int>? AudioFilter { get; }

        public static Messages Of(Object script) => new Messages(script);

        /// <summary>Logs an exception of a script and continues the frame, as Unity does.</summary>
        public void Send(Message message)
        {
            try
            {
                handlers[(int)message]?.Invoke();
            }
            catch (Exception error)
            {
                Debug.LogException(error, script);
            }
        }

        public static void SendByName(GameObject receiver, string name, object value)
        {
            foreach (Component component in new List<Component>(receiver.Components))
            {
                MethodInfo? method = component is MonoBehaviour ? Find(component.GetType(), name) : null;
                method?.Invoke(component, method.GetParameters().Length == 0 ? null : new[] { value });
            }
        }

        /// <summary>Calls OnValidate, as the editor does after it has changed an object.</summary>
        public static void Validate(Object script)
        {
            if (script is MonoBehaviour || script is ScriptableObject)
            {
                Find(script.GetType(), "OnValidate")?.Invoke(script, null);
            }
        }

        /// <summary>Calls Reset, as the editor does for a new component.</summary>
        public static void Reset(MonoBehaviour script) => Find(script.GetType(), "Reset")?.Invoke(script, null);

        private static MethodInfo? Find(Type? type, string name)
        {
            for (; type != null && type != typeof(MonoBehaviour) && type != typeof(ScriptableObject); type = type.BaseType)
            {
                MethodInfo? method = type.GetMethod(name, Anything | BindingFlags.DeclaredOnly);
                if (method != null)
                {
                    return method;
                }
            }
            return null;
        }
    }

    /// <summary>The state of a script in its life cycle.</summary>
    internal sealed class ScriptState
    {
        private readonly Messages messages;
        private readonly int audioGeneration = AudioDevice.Generation;
        private bool awake;
        private bool on;
        private bool begun;

        public ScriptState(MonoBehaviour script)
        {
            Script = script;
            messages = Messages.Of(script);
            Order = script.GetType().GetCustomAttribute<DefaultExecutionOrder>()?.order ?? 0;
        }

        public MonoBehaviour Script { get; }

        public int Order { get; }

        public System.Action<float[], int>? AudioFilter =>
            on && (!AudioDevice.DetachesFilters || audioGeneration == AudioDevice.Generation) ? messages.AudioFilter : null;

        public void Refresh()
        {
            if (!World.IsPlaying)
            {
                return;
            }
            if (!awake && Script.gameObject.activeInHierarchy)
            {
                awake = true;
                messages.Send(Message.Awake);
            }
            bool shouldBeOn = awake && Script.isActiveAndEnabled;
            if (shouldBeOn != on)
            {
                on = shouldBeOn;
                messages.Send(shouldBeOn ? Message.OnEnable : Message.OnDisable);
            }
        }

        public void Send(Message message)
        {
            if (!on || (message == Message.Start && begun))
            {
                return;
            }
            begun = begun || message == Message.Start;
            messages.Send(message);
        }

        public void End()
        {
            if (on)
            {
                on = false;
                messages.Send(Message.OnDisable);
            }
            if (awake)
            {
                awake = false;
                messages.Send(Message.OnDestroy);
            }
        }
    }
}
