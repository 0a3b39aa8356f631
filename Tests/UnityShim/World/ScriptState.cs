using System.Reflection;
using UnityEngine;

namespace UnityShim
{
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
